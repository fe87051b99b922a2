/* SPDX-License-Identifier: GPL-3.0-or-later */
/* returns.h -- return levels of a fitted law, how sure they are, and how well the law fits. */
#ifndef FL_STAT_RETURNS_H
#define FL_STAT_RETURNS_H
#include "stat/fit.h"

/* The return level x_T is exceeded once in a time T on average.  Values that come at a rate r [1/s] exceed it
 * with probability tail = 1 / (r T) each: for maxima of blocks r is one over their length, for peaks their
 * number over the length of the record.  For a GPD with threshold u this is x_T = u + (scale/shape) ((r
 * T)^shape - 1).
 *
 * Intervals are of 95 %, from the likelihood ratio W(q) = 2 (logL - largest logL of the laws whose level is
 * q): profile     W(q) <= 3.8415, the 95 % point of chi^2 with one degree of freedom, right for many values
 *     bootstrap   W(q) <= the 95 % point of W(x_T) among samples drawn from the fitted law and fitted again,
 * which is right for few values too: exactly where location and scale are all there is to fit Source: Coles
 * 2001, 2.6; Davison & Hinkley, Bootstrap Methods (1997), 5.4 and 4.2.3 on such test inversion. */
typedef struct {
    double tail, level;              /* level in the unit of the values */
    double profile[2], bootstrap[2]; /* NAN where there is no end */
} fl_return;

typedef struct {
    double kolmogorov, anderson;     /* distances of the sample from the law, as fl_fit_...() */
    double p_kolmogorov, p_anderson; /* share of the resamples that lie at least as far from their own fits */
} fl_goodness;

/* Fill levels and intervals of the maximum-likelihood fit best to the sorted x[n].
 *   m, r[m]     tail is given, 0 < tail < 1; the rest is out
 *   g           out, may be NULL
 *   resamples   0 for none (bootstrap and p are NAN); 199 or more for the 95 % point
 *   seed, entity   of the random numbers FL_RNG_BOOTSTRAP
 *   w           with cap >= n
 * Where fewer than nine resamples in ten can be fitted, bootstrap and p are NAN.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_returns(const fl_dist *best, int32_t n, const double *x, int32_t m, fl_return *r, fl_goodness *g,
               int32_t resamples, uint64_t seed, int64_t entity, fl_fit_work *w, fl_err *err);

#endif
