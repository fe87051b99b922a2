/* SPDX-License-Identifier: GPL-3.0-or-later */
/* no_tension.h -- damping never turns a pressure into tension: the correction where only sums are known.
 *
 * Damping multiplies the pressure e of each point by x, of which mean and variance var are known.  If x is
 * uniform over mean +- a, and s = a - mean > 0 is the length of the part below 0,
 *     p = mean of max(0, -x) = s^2/(4 a)
 *     q = mean of max(0, -x) (x - mean) / var = -s^2 (s/3 + mean/2)/(2 a var)
 * The part of the sums of e (n, t) that follows x is corrected along with it: by p times their mean and q
 * times their change with x.  If all of x is negative p = -mean and q = -1. */
#ifndef FL_PATCH_NO_TENSION_H
#define FL_PATCH_NO_TENSION_H
#include <math.h>
#include "base/simd.h"

#define FL_UNIFORM_HALF_WIDTH 1.7320508075688772 /* sqrt(3): a over the standard deviation of a uniform x */

typedef struct {
    double p, q;
} fl_no_tension;

/* Correction for x of this mean and variance.
 *   half_width   a, as x;  skewness: q over that of a uniform x */
FL_SIMD_INLINE fl_no_tension fl_no_tension_of(double mean, double var, double half_width, double skewness)
{
    const double s = half_width - mean;
    const int part = s < 2.0 * half_width; /* else all of x is negative */
    const double over = 0.5 * s * s / (part ? half_width : 1.0);
    const double p = part ? 0.5 * over : -mean,
                 x = part ? -skewness * over * (s / 3.0 + 0.5 * mean) / var : -1.0, q = x > -1.0 ? x : -1.0;
    return (fl_no_tension){s > 0.0 ? p : 0.0, s > 0.0 ? q : 0.0};
}

/* The a for which the correction is p; p > 0, mean + p >= 0. */
static inline double fl_no_tension_half_width(double mean, double p)
{
    const double pressed = mean + p;
    return pressed > 0.0 ? pressed + p + 2.0 * sqrt(p * pressed) : p;
}

#endif
