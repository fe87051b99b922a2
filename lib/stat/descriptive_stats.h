/* SPDX-License-Identifier: GPL-3.0-or-later */
/* descriptive_stats.h -- moments, extremes, quantiles and highest thirds of a record. */
#ifndef FL_STAT_DESCRIPTIVE_STATS_H
#define FL_STAT_DESCRIPTIVE_STATS_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n;
    double time;           /* sum of the weights [s] */
    double mean, std;      /* unit of the signal */
    double std_sample;     /* for a sample of independent values, see below */
    double skew, kurtosis; /* dimensionless; NAN for a constant record */
    double min, max;
    int32_t at_min, at_max; /* rows of the first smallest and the first largest value */
} fl_descriptive_stats;

/* Moments of values x that each last for a time w, with W = sum_k w_k:
 *     mean      = sum_k w_k x_k / W
 *     std^2     = sum_k w_k (x_k - mean)^2 / W               (1/n for equal weights)
 *     skew      = sum_k w_k ((x_k - mean) / std)^3 / W       (g1 for equal weights)
 *     kurtosis  = sum_k w_k ((x_k - mean) / std)^4 / W - 3   (excess: 0 for a normal distribution)
 *     std_sample^2 = std^2 / (1 - sum_k w_k^2 / W^2)         (1/(n-1) for equal weights; NAN for n = 1)
 *   x[n]  n >= 1
 *   w[n]  w > 0; NULL for equal weights 1
 * A std below the rounding of the values is set to 0.  Cannot fail. */
void fl_compute_moments(int32_t n, const double *x, const double *w, fl_descriptive_stats *d);

/* Quantiles q[m] at p[m] in 0 .. 1 of values x that each last for a time w.  In ascending order, value k has
 * the position (c_k - c_0) / (c_(n-1) - c_0), where c_k is the middle of its share of the time.  Between
 * positions the quantile is linear.  For equal weights the position is (k - 1) / (n - 1), type 7 of Hyndman &
 * Fan, The American Statistician 50 (1996) 361, as in GSL.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_compute_quantiles(int32_t n, const double *x, const double *w, int32_t m, const double *p, double *q,
                         fl_err *err);

/* Mean of the highest n * share values; the last one counts by its fraction.  share = 1/3 gives the
 * significant value.  descending[n] is sorted, n >= 1, 0 < share <= 1.  At least one whole value counts. */
double fl_mean_of_highest(int32_t n, const double *descending, double share);

#endif
