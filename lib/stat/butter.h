/* SPDX-License-Identifier: GPL-3.0-or-later */
/* butter.h -- Butterworth low-pass filters as second-order sections, run forward and backward.
 *
 * The analog prototype of order N has its poles on the unit circle, in pairs s^2 + q s + 1 with
 *     q_k = 2 sin(pi (2k - 1) / (2N)),  k = 1 .. N/2,
 * and one more at s = -1 when N is odd.  The bilinear transform with prewarping,
 *     s = (1/K) (1 - z^-1) / (1 + z^-1),  K = tan(pi fc / fs),
 * puts the -3 dB point exactly at fc and gives each pair the section
 *     H(z) = b0 (1 + 2 z^-1 + z^-2) / (1 + a1 z^-1 + a2 z^-2),
 *     a0 = 1 + q K + K^2,  a1 = 2 (K^2 - 1) / a0,  a2 = (1 - q K + K^2) / a0,  b0 = K^2 / a0.
 * |H|^2 = 1 / (1 + (tan(pi f/fs) / K)^(2N)).
 * Source: Oppenheim & Schafer, Discrete-Time Signal Processing (2010), sections 7.2 and 7.3. */
#ifndef FL_STAT_BUTTER_H
#define FL_STAT_BUTTER_H
#include <stdint.h>
#include "base/err.h"

enum { FL_BUTTER_ORDER_MAX = 20 };

/* (b0 + b1 z^-1 + b2 z^-2) / (1 + a1 z^-1 + a2 z^-2); b2 = a2 = 0 in a first-order section. */
typedef struct {
    double b0, b1, b2, a1, a2;
} fl_biquad;

typedef struct {
    int order, n;  /* n = (order + 1) / 2 sections, flattest first */
    double fc, fs; /* [Hz] */
    fl_biquad s[(FL_BUTTER_ORDER_MAX + 1) / 2];
} fl_butter;

/* Design a low-pass filter.
 *   order  1 .. FL_BUTTER_ORDER_MAX
 *   fc     -3 dB frequency of one pass      [Hz]
 *   fs     sampling rate, 0 < fc < fs / 2   [Hz]
 * The gain at zero frequency is 1 to rounding, however small fc is, so that a mean is kept.
 * 0, or -1 with FL_INPUT in err when a limit is broken. */
int fl_butter_low(fl_butter *f, int order, double fc, double fs, fl_err *err);

/* |H| of one pass at frequency freq [Hz]; forward and backward together have its square. */
double fl_butter_gain(const fl_butter *f, double freq);

/* The product of the sections, b[order + 1] and a[order + 1] with a[0] = 1.  For comparison with tables: a
 * filter of high order must not be run in this form, its poles are lost in rounding. */
void fl_butter_polynomials(const fl_butter *f, double *b, double *a);

/* Rows the filter needs beyond each end, at least 3 order fs / fc: there an impulse has died out. */
double fl_butter_pad(const fl_butter *f);

/* Filter forward, then backward: the gain is |H|^2 (-6 dB at fc), the phase zero.  Both ends are continued by
 * their reflection in the end point, 2 x_0 - x_k, and every section starts from the steady state of the first
 * value, so that a constant or a straight line passes unchanged.
 *   x[n]  equally spaced
 *   y[n]  out; may be x
 * 0, or -1 with FL_INPUT when the record is not longer than the pad, or FL_SYSTEM.
 * Source: Gustafsson 1996, IEEE Trans. Signal Process. 44:988, for the question of initial states. */
int fl_butter_zero_phase(const fl_butter *f, int32_t n, const double *x, double *y, fl_err *err);

#endif
