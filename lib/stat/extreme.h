/* SPDX-License-Identifier: GPL-3.0-or-later */
/* extreme.h -- ranks of values and their empirical probability of exceedance. */
#ifndef FL_STAT_EXTREME_H
#define FL_STAT_EXTREME_H
#include <stdint.h>
#include "base/err.h"

/* Ranks of n values: rank[0] is the index of the largest, in descending order; equal values keep their order.
 * rank[n] out.  0, or -1 with FL_SYSTEM in err. */
int fl_rank_descending(int32_t n, const double *x, int32_t *rank, fl_err *err);

/* Probability that a peak exceeds the one of rank i = 1 .. n in descending order, the Weibull plotting
 * position
 *     P_i = i / (n + 1).
 * Source: Weibull 1939; Makkonen 2006, J. Appl. Meteorol. Climatol. 45:334, for the choice of this
 * formula. */
double fl_plotting_position(int32_t i, int32_t n);

#endif
