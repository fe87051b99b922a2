/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes.h -- distributions of the plan areas of floes: areas of n floes, and the distance of other areas
 * from the law.
 *
 * A law is scaled to a given mean; only its shape counts here.  The areas of n floes are the means of the
 * law over n equal parts of probability,
 *    a_k = n  int_{k/n}^{(k+1)/n} Q(u) du  =  n m (H((k + 1)/n) - H(k/n)),   H(u) = int_0^u Q / int_0^1 Q,
 * with the quantile function Q, the mean m and the Lorenz curve H.  Their sum is n m, and their
 * distribution differs from the law by at most 1/n. */
#ifndef FL_ICE_SIZES_H
#define FL_ICE_SIZES_H
#include <stdint.h>

enum fl_sizes_kind { FL_SIZES_EQUAL, FL_SIZES_LOGNORMAL, FL_SIZES_WEIBULL, FL_SIZES_POWER, FL_SIZES_LIST };

/* Laws:
 *    EQUAL      all areas are equal
 *    LOGNORMAL  areas with given mean and coefficient of variation cv > 0
 *    WEIBULL    areas, shape k > 0: P(a) = 1 - exp(-(a / scale)^k)
 *    POWER      diameters D = sqrt(4 a / pi) with the density n(D) ~ D^-beta on [dmin, dmax]
 *    LIST       areas of a list or a table, with the probability of their counts */
typedef struct {
    enum fl_sizes_kind kind;
    double mean;              /* LOGNORMAL: of the areas [m2] */
    double cv, k;             /* LOGNORMAL, WEIBULL           */
    double beta;              /* POWER                        */
    double dmin, dmax;        /* POWER: 0 < dmin < dmax [m]   */
    int32_t n;                /* LIST                         */
    double *area;             /* LIST: [n], ascending [m2]    */
    double *cumulative_count; /* LIST: [n + 1] count of area[0 .. k), cumulative_count[0] = 0 */
    double *cumulative_area;  /* LIST: [n + 1] their total area [m2] */
} fl_sizes;

/* Relative difference below which sizes count as equal when distributions are compared: a law may have
 * jumps, and areas with an error of 1e-4 must not count as wrong. */
#define FL_SIZES_SAME_TOL 1e-4

/* Mean area of the law [m2]; 0 for EQUAL and WEIBULL, which have no scale. */
double fl_sizes_mean(const fl_sizes *s);

/* Ascending areas of n floes, area[n], scaled to the given mean [m2].  A list of n sizes with count 1
 * gives itself. */
void fl_sizes_areas(const fl_sizes *s, int32_t n, double mean, double *area);

/* Cumulative distribution: fraction of floes with an area of at most a, for the law scaled to the given
 * mean. */
double fl_sizes_cdf(const fl_sizes *s, double mean, double a);

/* Kolmogorov-Smirnov distance between the law, scaled to the given mean, and ascending areas: the largest
 * difference of the two distributions, with sizes equal within FL_SIZES_SAME_TOL. */
double fl_sizes_ks_distance(const fl_sizes *s, double mean, int32_t n, const double *area);

void fl_sizes_free(fl_sizes *s); /* accepts a zeroed struct, leaves a zeroed one */

#endif
