/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mean_interval.h -- confidence interval of the mean of a few independent runs, corrected for skewness.
 *
 * With s the standard deviation of n values and t = t(0.975, n - 1) Student's point,
 *     mean - t s / sqrt(n) .. mean + t s / sqrt(n)
 * is exact for normal values.  For a skewed distribution and few values it misses the mean too often on the
 * side of the long tail.  With a = G / sqrt(n), G the unbiased skewness of the sample, the statistic
 * T = (mean - true mean) sqrt(n) / s loses its skewness by
 *     T + a T^2 / 3 + a^2 T^3 / 27 + a / 6 = ((1 + a T / 3)^3 - 1) / a + a / 6,
 * which is solved for T = q(y) at y = +-t: mean - q(t) s / sqrt(n) .. mean - q(-t) s / sqrt(n).
 * Each end of the interval is the outer one of the two, because the skewness of a few values is itself
 * uncertain.  Both intervals converge and shrink as 1 / sqrt(n).  Two values have no skewness: Student's
 * interval.
 *
 * Coverage for distributions from normal to exponential: 93 to 97 % from five values on, see
 * tests/verify/verify_summary.c.
 * Source: Student 1908, Biometrika 6:1; Hall 1992, J. R. Stat. Soc. B 54:221, for the transformation. */
#ifndef FL_STAT_MEAN_INTERVAL_H
#define FL_STAT_MEAN_INTERVAL_H
#include <stdint.h>

typedef struct {
    double mean, std; /* std between the values, with n - 1; NAN for n = 1 */
    double low, high; /* ends of the 95 % interval; NAN for n = 1 */
} fl_mean_interval;

/* Mean of n >= 1 independent values x[n] and its 95 % interval.  The order of the values matters only to
 * rounding.  Cannot fail. */
fl_mean_interval fl_mean_interval_of(int32_t n, const double *x);

/* The interval of a quantity that has this sign by its nature, +1 or -1, and 0 for any: where it would pass
 * 0, its end there is mean exp(-d / |mean|), d the distance of that end, the interval of the logarithm to
 * first order.  Samples of one sign are no reason for it: the mean of a normal quantity may lie beyond 0. */
fl_mean_interval fl_mean_interval_of_sign(fl_mean_interval e, int sign);

/* Number of runs whose interval is mean (1 +- share), by (z s / (share mean))^2 + 2, z = 1.96; the 2 stand
 * for Student's t of few runs. */
double fl_runs_for(double std, double mean, double share);

#endif
