/* SPDX-License-Identifier: GPL-3.0-or-later */
/* resample.h -- resample a record of unequal intervals to equal ones; the impulse is preserved. */
#ifndef FL_STAT_RESAMPLE_H
#define FL_STAT_RESAMPLE_H
#include <stdint.h>

/* The common length of the intervals edge[k] .. edge[k + 1], k = 0 .. n - 1, when they are equal to 10^-6 of
 * their mean; no row is then displaced by more than 10^-6 of the whole record.  0 otherwise. */
double fl_resample_common_interval(int32_t n, const double *edge);

/* Means over m equal intervals of a record that is constant in each of its own,
 *     y_j = (1/h) sum_k x_k |[edge_k, edge_(k+1)] and [a_j, a_(j+1)]|,  a_j = edge_0 + j h,
 *     h = (edge_n - edge_0) / m,
 * so that sum_j y_j h = sum_k x_k (edge_(k+1) - edge_k) to rounding.
 *   edge[n + 1], x[n], even[m + 1] out: the a_j, y[m] out */
void fl_resample_means(int32_t n, const double *edge, const double *x, int32_t m, double *even, double *y);

#endif
