/* SPDX-License-Identifier: GPL-3.0-or-later */
/* estimate.h -- what a few runs say of the mean of all. */
#ifndef FL_STAT_ESTIMATE_H
#define FL_STAT_ESTIMATE_H
#include <stdint.h>

typedef struct {
    double mean, std; /* std between the values, with n - 1; NAN for n = 1 */
    double half;      /* half of the interval; NAN for n = 1 */
} fl_estimate;

/* Mean of n >= 1 independent values x[n] and its 95 % interval, mean +- half, by Student's law
 *     half = t(0.975, n - 1) std / sqrt(n),
 * which is exact for values that are normal, and holds for many values of any law.  Of few values of a skew
 * law it holds less often: of five exponential ones 88 times in a hundred.  The order of the values is free
 * but for rounding.  Cannot fail.  Source: Student 1908, Biometrika 6:1. */
fl_estimate fl_estimate_mean(int32_t n, const double *x);

#endif
