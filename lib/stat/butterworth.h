/* SPDX-License-Identifier: GPL-3.0-or-later */
/* butterworth.h -- Butterworth low, high and band pass filters as second-order sections, applied forward and
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
 * High pass: s -> 1/s and the numerator b0 (1 - 2 z^-1 + z^-2),
 *     |H|^2 = 1 / (1 + (K / tan(pi f/fs))^(2N)).
 * Band pass: s -> (s^2 + W^2) / (B s), W^2 = K1 K2, B = K2 - K1, with K1 and K2 the K of its two limits.
 * Each pole p of the prototype becomes the two roots of s^2 - p B s + W^2.  There are N sections with the
 * numerator b0 (1 - z^-2),
 *     |H|^2 = 1 / (1 + ((W^2 - t^2) / (B t))^(2N)),  t = tan(pi f/fs).
 * High and band pass have a gain of exactly 0 at zero frequency: they remove the mean.
 *
 *   f       frequency                          [Hz]
 *   fc, fs  -3 dB frequency, sampling rate     [Hz]
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
    int order, n;           /* n = (order + 1) / 2 sections, order sections for a band pass, flattest first */
    int degree;             /* of the polynomials: order, 2 order for a band pass */
    double fc, fs;          /* fc or the lower limit [Hz] */
    double decay_frequency; /* sets the length of the impulse response, see fl_butterworth_pad() [Hz] */
    double dc_gain;         /* of each section at zero frequency: 1, or 0 */
    fl_biquad s[FL_BUTTERWORTH_ORDER_MAX];
} fl_butterworth;

/* Design a low-pass filter.
 *   order  1 .. FL_BUTTERWORTH_ORDER_MAX
 *   fc     -3 dB frequency of one pass      [Hz]
 *   fs     sampling rate, 0 < fc < fs / 2   [Hz]
 * The gain at zero frequency is 1 to rounding for every fc, so the mean is preserved.
 * 0, or -1 with FL_INPUT in err when a limit is violated. */
int fl_butterworth_low(fl_butterworth *f, int order, double fc, double fs, fl_err *err);

/* Design a high pass, and a band pass between its -3 dB frequencies f1 and f2, 0 < f1 < f2 < fs / 2.  The
 * polynomials of a band pass have the degree 2 order. */
int fl_butterworth_high(fl_butterworth *f, int order, double fc, double fs, fl_err *err);
int fl_butterworth_band(fl_butterworth *f, int order, double f1, double f2, double fs, fl_err *err);

/* |H| of one pass at frequency freq [Hz].  Forward and backward together have the gain |H|^2. */
double fl_butterworth_gain(const fl_butterworth *f, double freq);

/* The product of the sections: b[order + 1] and a[order + 1] with a[0] = 1; 2 order + 1 for a band pass.  For
 * comparison with tables only: a filter of high order run in this form loses its poles to rounding. */
void fl_butterworth_polynomials(const fl_butterworth *f, double *b, double *a);

/* Rows of padding beyond each end: 3 order fs / decay_frequency, rounded up, after which an impulse has
 * decayed.  decay_frequency is fc; for a band pass the smaller of the lower limit and half the width. */
double fl_butterworth_pad(const fl_butterworth *f);

/* Filter forward, then backward: the gain is |H|^2 (-6 dB at fc), the phase zero.  Both ends are extended by
 * reflection in the end point, 2 x_0 - x_k.  Every section starts from the steady state of the first value.
 * A constant or a straight line passes a low pass unchanged and a high or band pass removes it.
 *   x[n]  equally spaced
 *   y[n]  out; may be x
 * 0, or -1 with FL_INPUT when the record is not longer than the pad, or FL_SYSTEM.
 * Source: Gustafsson 1996, IEEE Trans. Signal Process. 44:988, for the choice of initial states. */
int fl_butterworth_zero_phase(const fl_butterworth *f, int32_t n, const double *x, double *y, fl_err *err);

#endif
