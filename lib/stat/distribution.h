/* SPDX-License-Identifier: GPL-3.0-or-later */
/* distribution.h -- probability distributions of load peaks and extremes.
 *
 * With z = (x - location) / scale and the reduced variate w = ln(1 + shape z) / shape (w = z for shape = 0):
 *     Weibull     F = 1 - exp(-z^shape)                  location 0, z > 0
 *     Gumbel      F = exp(-exp(-z))                      shape unused, 0
 *     log-normal  F = Phi(ln(z) / shape)                 location 0, z > 0; scale is exp(mean of ln x)
 *     GEV         F = exp(-exp(-w))                      shape > 0 heavy tail, < 0 bounded above
 *     GPD         F = 1 - exp(-w)                        excesses over the location, x > location
 * The sign of the shape is that of the tail; some libraries use the opposite one.
 * Source: Coles, An Introduction to Statistical Modeling of Extreme Values (2001), ch. 3 and 4. */
#ifndef FL_STAT_DISTRIBUTION_H
#define FL_STAT_DISTRIBUTION_H

enum fl_dist_kind { FL_WEIBULL, FL_GUMBEL, FL_LOGNORMAL, FL_GEV, FL_GPD, FL_DISTS };

typedef struct {
    int kind;
    double location, scale, shape; /* location and scale in the unit of x */
} fl_dist;

/* "weibull", "gumbel", "lognormal", "gev", "gpd" */
const char *fl_dist_name(int kind);

/* Number of free parameters: 2, for a GEV 3.  The location of a GPD is the threshold, which is given. */
int fl_dist_parameter_count(int kind);

/* P(X <= x), P(X > x) and ln of the density [1/unit of x]; -INFINITY outside the support.  Cannot fail. */
double fl_dist_cdf(const fl_dist *d, double x);
double fl_dist_survival(const fl_dist *d, double x);
double fl_dist_log_density(const fl_dist *d, double x);

/* The value that is exceeded with probability tail, 0 < tail < 1.  Exact to rounding for small tails too:
 * 1 - tail is never formed. */
double fl_dist_upper_quantile(const fl_dist *d, double tail);

/* ln(1 + shape z) / shape and its inverse (exp(shape w) - 1) / shape, continuous through shape = 0. */
double fl_dist_reduced_variate(double shape, double z);
double fl_dist_from_reduced_variate(double shape, double w);

#endif
