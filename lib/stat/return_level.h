/* SPDX-License-Identifier: GPL-3.0-or-later */
/* return_level.h -- return levels of a fitted distribution with confidence intervals, and goodness of fit.
 *
 * The return level x_T is exceeded once in a time T on average.  Values that occur at a rate r [1/s] exceed
 * it with probability tail = 1 / (r T) each.  For block maxima r is 1 / (length of a block); for peaks it is
 * their number over the length of the record.  For a GPD with threshold u
 *     x_T = u + (scale/shape) ((r T)^shape - 1).
 *
 * 95 % intervals follow from the likelihood ratio
 *     W(q) = 2 (logL - largest logL of distributions whose level is q):
 *     profile      W(q) <= n ln(1 + t^2 / (n - p)),  t = t(0.975, n - p),  p free parameters
 *     bootstrap    W(q) <= the 95 % point of W(x_T) among samples drawn from the fitted distribution and
 *                  fitted again; for a GEV and a GPD at least the limit of the profile
 * The limit of the profile is exact for the mean of a normal distribution.  It tends to 3.8415, the chi^2
 * point with one degree of freedom, which alone is too low for few values.  Resampling corrects the
 * remainder.  Many resamples of few values of a GEV or GPD end at the smallest shape (fit.h), where W is too
 * small; hence the bound.  For 20 and for 50 values both intervals cover the level in 93 to 97 % of cases
 * (verify_fits.c). Source: Coles 2001, 2.6; Davison & Hinkley, Bootstrap Methods (1997), 4.2.3 and 5.4, for
 * this inversion of tests; Bates & Watts, Nonlinear Regression Analysis (1988), 6.1, for the profile with
 * Student's t. */
#ifndef FL_STAT_RETURN_LEVEL_H
#define FL_STAT_RETURN_LEVEL_H
#include "stat/fit.h"

typedef struct {
    double tail, level;              /* level in the unit of the values */
    double profile[2], bootstrap[2]; /* NAN where there is no end */
} fl_return_level;

typedef struct {
    double kolmogorov, anderson;     /* distances of the sample from the distribution, as fl_fit_...() */
    double p_kolmogorov, p_anderson; /* share of the resamples at least as far from their own fits */
} fl_goodness_of_fit;

/* Compute levels and intervals of the maximum-likelihood fit best to the sorted x[n].
 *   m, r[m]     tail is given, 0 < tail < 1; the rest is out
 *   g           out, may be NULL
 *   resamples   0 for none (bootstrap and p are NAN); 199 or more for the 95 % point
 *   seed, entity   of the random numbers FL_RNG_BOOTSTRAP
 *   w           with cap >= n
 * Where fewer than nine resamples in ten can be fitted, bootstrap and p are NAN.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_compute_return_levels(const fl_dist *best, int32_t n, const double *x, int32_t m, fl_return_level *r,
                             fl_goodness_of_fit *g, int32_t resamples, uint64_t seed, int64_t entity,
                             fl_fit_work *w, fl_err *err);

#endif
