/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes.h -- laws for the plan areas of floes: which areas n floes have, and how far others are from that.
 *
 * A law is scaled to a wanted mean: its shape is what matters here.  The areas of n floes are the means of
 * the law over n equal parts of probability,
 *     a_k = n  int_{k/n}^{(k+1)/n} Q(u) du  =  n m (H((k + 1)/n) - H(k/n)),   H(u) = int_0^u Q / int_0^1 Q,
 * Q being the quantile function, m the mean and H the Lorenz curve: their sum is n m, and their distribution
 * is nowhere more than 1/n from the law. */
#ifndef FL_ICE_SIZES_H
#define FL_ICE_SIZES_H
#include <stdint.h>

enum fl_sizes_kind { FL_SIZES_EQUAL, FL_SIZES_LOGNORMAL, FL_SIZES_WEIBULL, FL_SIZES_POWER, FL_SIZES_LIST };

/* EQUAL      all areas are the same
 * LOGNORMAL  of areas with the given mean and standard deviation over mean, cv > 0
 * WEIBULL    of areas, of shape k > 0: P(a) = 1 - exp(-(a / scale)^k)
 * POWER      of diameters D = sqrt(4 a / pi), with the density n(D) ~ D^-beta on [dmin, dmax]
 * LIST       the areas of a list or a table, as probable as they are counted there */
typedef struct {
    enum fl_sizes_kind kind;
    double mean;              /* LOGNORMAL: of the areas [m2] */
    double cv, k;             /* LOGNORMAL, WEIBULL           */
    double beta;              /* POWER                        */
    double dmin, dmax;        /* POWER: 0 < dmin < dmax [m]   */
    int32_t n;                /* LIST                         */
    double *area;             /* LIST: [n], ascending [m2]    */
    double *cumulative_count; /* LIST: [n + 1] how many have area[0 .. k), upto[0] = 0 */
    double *cumulative_area;  /* LIST: [n + 1] what they cover     [m2] */
} fl_sizes;

/* Sizes within this part of each other count as the same when distributions are compared: where a law has
 * jumps, areas that are right to a tenth of a thousandth must not count as wrong. */
#define FL_SIZES_SAME_TOL 1e-4

/* Mean area of the law [m2]; 0 for EQUAL and WEIBULL, which have none of their own. */
double fl_sizes_mean(const fl_sizes *s);

/* The ascending areas of n floes, area[n], scaled to the given mean [m2].  A list of n that counts each once
 * gives itself. */
void fl_sizes_areas(const fl_sizes *s, int32_t n, double mean, double *area);

/* The part of all floes whose area is at most a, when the law is scaled to the given mean. */
double fl_sizes_cdf(const fl_sizes *s, double mean, double a);

/* Kolmogorov-Smirnov distance between the law, scaled to the given mean, and ascending areas: the largest
 * difference of the two distributions, sizes being the same as FL_SIZES_SAME_TOL says. */
double fl_sizes_ks_distance(const fl_sizes *s, double mean, int32_t n, const double *area);

void fl_sizes_free(fl_sizes *s); /* accepts a zeroed struct, leaves one */

#endif
