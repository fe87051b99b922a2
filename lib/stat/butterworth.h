/* SPDX-License-Identifier: GPL-3.0-or-later */
/* butterworth.h -- Butterworth filters, low, high and band pass, as second-order sections run forward and
 * backward.
 *
 * The analog prototype of order N has its poles on the unit circle, in pairs s^2 + q s + 1 with
 *     q_k = 2 sin(pi (2k - 1) / (2N)),  k = 1 .. N/2,
 * and one more at s = -1 when N is odd.  The bilinear transform with prewarping,
 *     s = (1/K) (1 - z^-1) / (1 + z^-1),  K = tan(pi fc / fs),
 * puts the -3 dB point exactly at fc and gives each pair the section
 *     H(z) = b0 (1 + 2 z^-1 + z^-2) / (1 + a1 z^-1 + a2 z^-2),
 *     a0 = 1 + q K + K^2,  a1 = 2 (K^2 - 1) / a0,  a2 = (1 - q K + K^2) / a0,  b0 = K^2 / a0.
 * |H|^2 = 1 / (1 + (tan(pi f/fs) / K)^(2N)).
 *
 * A high pass has s -> 1/s and the numerator b0 (1 - 2 z^-1 + z^-2),
 *     |H|^2 = 1 / (1 + (K / tan(pi f/fs))^(2N)).
 * A band pass has s -> (s^2 + W^2) / (B s), W^2 = K1 K2, B = K2 - K1, where K1 and K2 are the K of its
 * limits: each pole p of the prototype becomes the two roots of s^2 - p B s + W^2, and there are N sections
 * with the numerator b0 (1 - z^-2),
 *     |H|^2 = 1 / (1 + ((W^2 - t^2) / (B t))^(2N)),  t = tan(pi f/fs).
 * Both have a gain of exactly 0 at zero frequency: a mean is taken out.
 * Source: Oppenheim & Schafer, Discrete-Time Signal Processing (2010), sections 7.2 and 7.3. */
#ifndef FL_STAT_BUTTERWORTH_H
#define FL_STAT_BUTTERWORTH_H
#include <stdint.h>
#include "base/err.h"

enum { FL_BUTTERWORTH_ORDER_MAX = 20 };

/* (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2); b2 = a2 = 0 in a first-order section. */
typedef struct {
    double b0, b1, b2, a1, a2;
} fl_biquad;

typedef struct {
    int order, n;           /* n = (order + 1) / 2 sections, of a band pass order, flattest first */
    int degree;             /* of the polynomials: order, of a band pass 2 order */
    double fc, fs;          /* fc or the lower limit [Hz] */
    double decay_frequency; /* the frequency that says how long an impulse lives [Hz] */
    double dc_gain;         /* gain of each section at zero frequency: 1, or 0 */
    fl_biquad s[FL_BUTTERWORTH_ORDER_MAX];
} fl_butterworth;

/* Design a low-pass filter.
 *   order  1 .. FL_BUTTERWORTH_ORDER_MAX
 *   fc     -3 dB frequency of one pass      [Hz]
 *   fs     sampling rate, 0 < fc < fs / 2   [Hz]
 * The gain at zero frequency is 1 to rounding, however small fc is, so that a mean is kept.
 * 0, or -1 with FL_INPUT in err when a limit is broken. */
int fl_butterworth_low(fl_butterworth *f, int order, double fc, double fs, fl_err *err);

/* The same for a high pass, and for a band pass from f1 to f2, 0 < f1 < f2 < fs / 2, its two -3 dB
 * frequencies; the polynomials of a band pass have the degree 2 order. */
int fl_butterworth_high(fl_butterworth *f, int order, double fc, double fs, fl_err *err);
int fl_butterworth_band(fl_butterworth *f, int order, double f1, double f2, double fs, fl_err *err);

/* |H| of one pass at frequency freq [Hz]; forward and backward together have its square. */
double fl_butterworth_gain(const fl_butterworth *f, double freq);

/* The product of the sections, b[order + 1] and a[order + 1] with a[0] = 1; 2 order + 1 of a band pass.  For
 * comparison with tables: a filter of high order must not be run in this form, its poles are lost in
 * rounding. */
void fl_butterworth_polynomials(const fl_butterworth *f, double *b, double *a);

/* Rows the filter needs beyond each end, at least 3 order fs / slow: there an impulse has died out.  slow is
 * fc; of a band pass the lower limit or half of its width, whichever is less. */
double fl_butterworth_pad(const fl_butterworth *f);

/* Filter forward, then backward: the gain is |H|^2 (-6 dB at fc), the phase zero.  Both ends are continued by
 * their reflection in the end point, 2 x_0 - x_k, and every section starts from the steady state of the first
 * value, so that a constant or a straight line passes a low pass unchanged, and leaves nothing behind a high
 * or band pass. x[n]  equally spaced y[n]  out; may be x 0, or -1 with FL_INPUT when the record is not longer
 * than the pad, or FL_SYSTEM. Source: Gustafsson 1996, IEEE Trans. Signal Process. 44:988, for the question
 * of initial states. */
int fl_butterworth_zero_phase(const fl_butterworth *f, int32_t n, const double *x, double *y, fl_err *err);

#endif
