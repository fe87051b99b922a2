/* SPDX-License-Identifier: GPL-3.0-or-later */
/* power_spectrum.h -- power spectral density by Welch's method: the mean over segments that overlap by half.
 *
 * With a window w[L], X_k = sum_j w_j (x_j - mean) exp(-2 pi i j k / L) of each segment, and
 *     P_k = 2 |X_k|^2 / (fs sum_j w_j^2),  k = 0 .. L/2  (at 0 and fs/2 without the 2)
 * averaged over the segments.  P is one-sided [unit^2/Hz].  sum_k P_k df, df = fs / L, is the mean of
 * w^2 (x - mean)^2 over that of w^2: the variance, but for the weight of the window (Parseval).  A sine of
 * amplitude A has its peak A^2 / (2 ENBW) at its frequency, ENBW = fs sum w^2 / (sum w)^2 [Hz].
 * Source: Welch 1967, IEEE Trans. Audio Electroacoust. 15:70; Harris 1978, Proc. IEEE 66:51, for windows. */
#ifndef FL_STAT_POWER_SPECTRUM_H
#define FL_STAT_POWER_SPECTRUM_H
#include <stdint.h>
#include "base/err.h"

/* Periodic windows, with u = 2 pi j / L:
 *   hann      (1 - cos u) / 2
 *   hamming   0.54 - 0.46 cos u
 *   blackman  0.42 - 0.5 cos u + 0.08 cos 2u
 *   none      1 */
enum fl_taper { FL_TAPER_HANN, FL_TAPER_HAMMING, FL_TAPER_BLACKMAN, FL_TAPER_NONE, FL_TAPERS };

enum { FL_SPECTRUM_SHORTEST_SEGMENT = 4, FL_SPECTRUM_SEGMENTS = 8 };

/* "hann", "hamming", "blackman", "none" */
const char *fl_taper_name(int taper);

typedef struct {
    int taper;
    int32_t length, step, segments; /* rows of a segment, offset between segments, number of segments */
    int32_t n;                      /* length / 2 + 1 frequencies k df */
    double fs, df, enbw;            /* [Hz] */
    double dof;                     /* degrees of freedom of P_k, see fl_power_spectrum_interval() */
    double *psd;                    /* [n] P_k [unit^2/Hz] */
} fl_power_spectrum;

/* Default segment length, for FL_SPECTRUM_SEGMENTS segments or a few more: the largest even product of 2, 3
 * and 5 not above 2 n / (FL_SPECTRUM_SEGMENTS + 1); n itself where that is below
 * FL_SPECTRUM_SHORTEST_SEGMENT. */
int32_t fl_spectrum_segment_length(int32_t n);

/* The spectrum of x[n], equally spaced at the rate fs [Hz].  Rows after the last whole segment are not used.
 *   length   of a segment, FL_SPECTRUM_SHORTEST_SEGMENT .. n
 * 0, or -1 with FL_INPUT (a length out of range) or FL_SYSTEM in err. */
int fl_power_spectrum_make(fl_power_spectrum *s, int32_t n, const double *x, double fs, int32_t length,
                           int taper, fl_err *err);

/* sum_k P_k df: the variance [unit^2]. */
double fl_power_spectrum_variance(const fl_power_spectrum *s);

/* The 95 % interval of the spectrum at k df, nu P_k / chi^2_nu(0.975) .. nu P_k / chi^2_nu(0.025), for a
 * record of a normal process whose spectrum is smooth over ENBW.  Overlapping segments are correlated:
 *     nu = 2 K / (1 + 2 sum_j (1 - j/K) r_j^2),  r_j = sum_i w_i w_(i + j step) / sum_i w_i^2,
 * and half of that at 0 and fs/2.  Source: Welch 1967. */
void fl_power_spectrum_interval(const fl_power_spectrum *s, int32_t k, double *low, double *high);

/* Dominant frequency [Hz]: the highest maximum between two smaller values with at least two periods in a
 * segment (slower ones cannot be distinguished from a drift).  Interpolated by a parabola through the
 * logarithms of the three values; for a sine the error is below 0.02 df, 0.2 df without a window.  *at (may
 * be NULL) is its k.  NAN, and *at = -1, where there is no such maximum. */
double fl_power_spectrum_dominant(const fl_power_spectrum *s, int32_t *at);

/* Share of the variance within two df of k df: the width of the peak of a sine with a window. */
double fl_power_spectrum_share(const fl_power_spectrum *s, int32_t k);

/* Mean rate of upward crossings of the mean of a normal process of this spectrum (Rice 1944),
 * sqrt(sum f^2 P / sum P) [Hz]; NAN for a constant. */
double fl_power_spectrum_crossing_rate(const fl_power_spectrum *s);

/* Accepts a zeroed struct and leaves one. */
void fl_power_spectrum_free(fl_power_spectrum *s);

#endif
