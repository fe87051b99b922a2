/* SPDX-License-Identifier: GPL-3.0-or-later */
/* no_tension.h -- damping never makes a pressure a pull: how much is held back where only sums are known.
 *
 * Damping multiplies the pressures e of places by x, of which the mean and the variance are known.  Spread
 * evenly over mean +- a, with s = a - mean below 0,
 *     p = mean of max(0, -x) = s^2/4a,
 *     q = mean of max(0, -x) (x - mean) / var = -s^2 (s/3 + mean/2)/(2 a var),
 * and of sums of e (n, t) what follows x is given back with it: p times their mean and q times what they
 * change by as x does.  All pulled: p = -mean, q = -1. */
#ifndef FL_PATCH_NO_TENSION_H
#define FL_PATCH_NO_TENSION_H
#include <math.h>
#include "base/simd.h"

#define FL_UNIFORM_HALF_WIDTH                                                                                \
    1.7320508075688772 /* a over the root of the variance, where x is spread evenly */

typedef struct {
    double p, q;
} fl_no_tension;

/* wide: a [as x]; lean: what q is times that of an even spread */
FL_SIMD_INLINE fl_no_tension fl_no_tension_of(double mean, double var, double wide, double lean)
{
    const double s = wide - mean;
    const int part = s < 2.0 * wide; /* else all of it */
    const double over = 0.5 * s * s / (part ? wide : 1.0);
    const double p = part ? 0.5 * over : -mean, x = part ? -lean * over * (s / 3.0 + 0.5 * mean) / var : -1.0,
                 q = x > -1.0 ? x : -1.0;
    return (fl_no_tension){s > 0.0 ? p : 0.0, s > 0.0 ? q : 0.0};
}

/* The a of which so much is held back: p > 0, mean + p >= 0. */
static inline double fl_no_tension_half_width(double mean, double p)
{
    const double pressed = mean + p;
    return pressed > 0.0 ? pressed + p + 2.0 * sqrt(p * pressed) : p;
}

#endif
