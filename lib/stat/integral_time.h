/* SPDX-License-Identifier: GPL-3.0-or-later */
/* integral_time.h -- integral time of a record, and how well its mean is known.
 *
 * Values of a record are not independent.  With rho(k) the correlation of rows k apart and h the length of a
 * row,
 *     tau = h (1/2 + rho(1) + rho(2) + ...),   up to the first rho that is not above 0,
 * a record of length T holds n = T / (2 tau) independent values, and the standard error of its mean is
 *     s / sqrt(n) = s sqrt(2 tau / T).
 * tau is h/2 for independent rows, h (1 + r) / (2 (1 - r)) for rho(k) = r^k.
 *
 * Rows of unequal length are taken as of their mean length.  A record of more than 8192 rows is first
 * averaged over groups of rows of equal number, so tau is at least half of a group.
 * Source: Priestley, Spectral Analysis and Time Series (1981), 5.3.2; the cut at the first zero as in Sokal,
 * Monte Carlo Methods in Statistical Mechanics (1997), 3, whose window is longer. */
#ifndef FL_STAT_INTEGRAL_TIME_H
#define FL_STAT_INTEGRAL_TIME_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    double tau; /* [s]; 0 for a constant record */
    double n;   /* independent values, at least 1 */
    double low,
        high; /* 95 % interval of the mean, by Student's t with n - 1, at least 1, degrees of freedom */
} fl_record_mean;

/* Of x[n], n >= 1, over a time span [s], with its mean and standard deviation.  An interval that would pass
 * 0 and holds only values of one sign ends at mean exp(-t s / (|mean| sqrt(n))) instead, that of the
 * logarithm.  0, or -1 with FL_SYSTEM in err. */
int fl_record_mean_make(fl_record_mean *m, int32_t n, const double *x, double span, double mean, double std,
                        int one_sign, fl_err *err);

/* The end of an interval of a positive quantity on the side of 0, where mean - reach would pass it. */
double fl_interval_end(double mean, double reach);

#endif
