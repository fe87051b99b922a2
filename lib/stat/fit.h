/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fit.h -- fit a distribution to a sample by maximum likelihood, L-moments or moments.
 *
 * Maximum likelihood is one search along one line for every distribution, because
 *     x Weibull (k, s)             -> -ln x is Gumbel (-ln s, 1/k)
 *     x GEV, theta = shape/scale'  -> ln(1 + theta (x - mean)) / theta is Gumbel (m, b), and then
 *                                     shape = theta b, scale = b e^(theta m),
 *                                     location = mean + (e^(theta m) - 1) / theta
 *     y GPD, theta = shape/scale   -> ln(1 + theta y) / theta is exponential with mean scale = shape/theta
 * and the Gumbel b is the one root of the monotone  b = mean(z) - sum(z e^(-z/b)) / sum(e^(-z/b)).
 * Source: Grimshaw 1993, Technometrics 35:185, for the GPD; the GEV by the same idea.
 *
 * The shape of a GEV and a GPD is limited to -1/2 and more.  Below -1/2 the likelihood is not regular, below
 * -1 it is unbounded.  The maximum is the local one, found uphill from the L-moment fit.  Where there is
 * none above -1/2, the result is the most likely distribution of shape -1/2, by a search for its upper end e
 * > max x, with
 *     GPD          scale = -shape (e - location)
 *     GEV          scale = -shape s, location = e - s, s^k = mean((e - x)^k), k = -1/shape
 * Source: Smith 1985, Biometrika 72:67, for the bound.
 *
 * L-moments are the unbiased ones, l1, l2, t3 = l3/l2.  Source: Hosking 1990, J. R. Stat. Soc. B 52:105.
 * Moments are the mean, s with n - 1, and for the GEV the skewness g1. */
#ifndef FL_STAT_FIT_H
#define FL_STAT_FIT_H
#include <stdint.h>
#include "base/err.h"
#include "stat/distribution.h"

enum fl_fit_method { FL_FIT_LIKELIHOOD, FL_FIT_L_MOMENTS, FL_FIT_MOMENTS, FL_FIT_METHODS };

/* "mle", "lmoments", "moments" */
const char *fl_fit_method_name(int method);

/* Scratch for fits of samples of up to cap values, one per thread. */
typedef struct {
    int32_t cap;
    double *z;          /* [cap] */
    void *line, *plane; /* minimisers of GSL along a line and in a plane */
} fl_fit_work;

/* Switches GSL's error handler off.  0, or -1 with FL_SYSTEM in err. */
int fl_fit_work_make(fl_fit_work *w, int32_t cap, fl_err *err);
/* Accepts a zeroed struct and leaves one. */
void fl_fit_work_free(fl_fit_work *w);

/* Fit a distribution.
 *   n, x[n]    sorted, ascending or descending, n <= w->cap
 *   location   threshold of a GPD, below all x; unused otherwise
 * Returns 1, or 0 where no fit exists: too few values (3, for a GEV 4), all values equal, values <= 0 for a
 * positive distribution, or moments outside the range of the distribution. */
int fl_fit(fl_dist *d, int kind, int method, int32_t n, const double *x, double location, fl_fit_work *w);

/* sum ln density; -INFINITY when a value is outside the support. */
double fl_fit_log_likelihood(const fl_dist *d, int32_t n, const double *x);

/* The largest log-likelihood of all distributions of this kind whose upper quantile at probability tail is q.
 * start is the maximum-likelihood fit.  -INFINITY when there is none.  found may be NULL. */
double fl_fit_constrained(const fl_dist *start, int32_t n, const double *x, double tail, double q,
                          fl_fit_work *w, fl_dist *found);

/* Akaike's criterion, 2 (free parameters) - 2 logL: the smallest is best among fits to the same sample. */
double fl_fit_aic(const fl_dist *d, double log_likelihood);

/* L-moments of a sorted sample, n >= 3: l[0] = l1, l[1] = l2, l[2] = t3. */
void fl_fit_l_moments(int32_t n, const double *x, double l[3]);

/* Distance of a sorted sample from a distribution:
 *     Kolmogorov-Smirnov   D = max |F_n - F|, F_n just below and at each value
 *     Anderson-Darling     A^2 = -n - (1/n) sum_i (2 i - 1) (ln F(x_i) + ln(1 - F(x_(n+1-i)))), x rising
 * Tables of their probabilities hold only for distributions that were not fitted to the same sample. */
double fl_fit_kolmogorov(const fl_dist *d, int32_t n, const double *x);
double fl_fit_anderson(const fl_dist *d, int32_t n, const double *x);

#endif
