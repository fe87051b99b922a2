/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stationary.h -- whether the mean of a record stays.
 *
 * Two tests, each of which can say no:
 *
 * Halves.  Each half has a mean m, a standard deviation s and an integral time tau, integral_time.h, so n =
 * T / (2 tau) independent values.  The halves are
 *     z = (m2 - m1) / sqrt(s1^2/n1 + s2^2/n2)
 * standard errors apart.  The mean moves where |z| is above Student's point of the probability that a normal
 * number is above 2, with n1 + n2 - 2 degrees of freedom, and the means differ by more than a tenth of the
 * larger one.
 *
 * Trend.  Means of B blocks of equal length, B at most 20 and the independent values, at least 10, are
 * compared by pairs: S counts later ones that are larger less those that are smaller, and without a trend
 *     z_B = (S - sign S) / sqrt(B (B - 1) (2 B + 5) / 18)
 * is normal.  The mean moves where |z_B| is above 2.58 and the halves differ as above.
 *
 * A stationary record fails in about one case of twenty.  With fewer than five independent values in a half
 * nothing can be said: the record is one event.
 * Source: Welch 1947, Biometrika 34:28; Mann 1945, Econometrica 13:245. */
#ifndef FL_STAT_STATIONARY_H
#define FL_STAT_STATIONARY_H
#include <stdint.h>
#include "base/err.h"

/* Independent values that each half needs. */
#define FL_STATIONARY_LEAST 5.0

typedef struct {
    double mean[2], n[2]; /* of the halves: mean, independent values */
    double apart;         /* z of the halves; 0 for a constant record */
    double trend;         /* z_B; 0 where there are fewer than 10 blocks */
    int judged;           /* both halves have FL_STATIONARY_LEAST independent values */
    int moves;            /* judged, and the mean does not stay */
} fl_stationarity;

/* Of x[n], rows of equal length over a time span [s].  A record of fewer than four rows is not judged.  0, or
 * -1 with FL_SYSTEM in err. */
int fl_stationarity_make(fl_stationarity *s, int32_t n, const double *x, double span, fl_err *err);

#endif
