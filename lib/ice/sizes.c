/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_sf_gamma.h>
#include "base/pi.h"
#include "ice/sizes.h"

/* int_0^y e^(q t) dt = (e^(q y) - 1) / q.  With y = ln(D / dmin) the distribution of a power law is the
 * ratio of two of these, q = 1 - beta, and so is its Lorenz curve of areas, q = 3 - beta. */
static double exp_integral(double q, double y) { return q == 0.0 ? y : expm1(q * y) / q; }

/* The y for which exp_integral(q, y) is u exp_integral(q, end). */
static double inverse_exp_integral(double q, double u, double end)
{
    const double whole = expm1(q * end);
    /* the second term of the series is below the rounding of the first */
    if (fabs(whole) < 1e-12) return u * end;
    return log1p(u * whole) / q;
}

static double log_range(const fl_sizes *s) { return log(s->dmax / s->dmin); }

double fl_sizes_mean(const fl_sizes *s)
{
    switch (s->kind) {
    case FL_SIZES_LOGNORMAL: return s->mean;
    case FL_SIZES_POWER:
        return 0.25 * PI * s->dmin * s->dmin * exp_integral(3.0 - s->beta, log_range(s)) /
               exp_integral(1.0 - s->beta, log_range(s));
    case FL_SIZES_LIST: return s->cumulative_area[s->n] / s->cumulative_count[s->n];
    default: return 0.0;
    }
}

/* Index of the size of the x-th floe of the list. */
static int32_t find_size(const fl_sizes *s, double x)
{
    int32_t lo = 0, hi = s->n - 1;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (s->cumulative_count[mid + 1] <= x) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

static double lorenz_curve(const fl_sizes *s, double u)
{
    if (!(u > 0.0)) return 0.0;
    if (!(u < 1.0)) return 1.0;
    switch (s->kind) {
    case FL_SIZES_LOGNORMAL:
        return gsl_cdf_ugaussian_P(gsl_cdf_ugaussian_Pinv(u) - sqrt(log1p(s->cv * s->cv)));
    case FL_SIZES_WEIBULL: return gsl_sf_gamma_inc_P(1.0 + 1.0 / s->k, -log1p(-u));
    case FL_SIZES_POWER:
        return exp_integral(3.0 - s->beta, inverse_exp_integral(1.0 - s->beta, u, log_range(s))) /
               exp_integral(3.0 - s->beta, log_range(s));
    case FL_SIZES_LIST: {
        const double x = u * s->cumulative_count[s->n];
        const int32_t k = find_size(s, x);
        return (s->cumulative_area[k] + (x - s->cumulative_count[k]) * s->area[k]) / s->cumulative_area[s->n];
    }
    default: return u;
    }
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void fl_sizes_areas(const fl_sizes *s, int32_t n, double mean, double *area)
{
    double before = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const double h = lorenz_curve(s, (k + 1.0) / n);
        area[k] = n * mean * (h - before);
        before = h;
        if (s->kind == FL_SIZES_EQUAL) area[k] = mean;
        if (s->kind == FL_SIZES_LIST && n == s->n && s->cumulative_count[n] == n)
            area[k] = s->area[k] * (mean / fl_sizes_mean(s));
    }
    /* for parts with the same size, rounding may have changed the order */
    qsort(area, (size_t)n, sizeof *area, by_value);
}

/* Number of sizes of the list that are at most a. */
static int32_t count_at_most(const fl_sizes *s, double a)
{
    int32_t lo = 0, hi = s->n;
    while (lo < hi) {
        const int32_t mid = lo + (hi - lo) / 2;
        if (s->area[mid] <= a) lo = mid + 1;
        else hi = mid;
    }
    return lo;
}

double fl_sizes_cdf(const fl_sizes *s, double mean, double a)
{
    double y;
    if (!(a > 0.0)) return 0.0;
    switch (s->kind) {
    case FL_SIZES_LOGNORMAL: {
        const double var = log1p(s->cv * s->cv);
        return gsl_cdf_ugaussian_P((log(a / mean) + 0.5 * var) / sqrt(var));
    }
    case FL_SIZES_WEIBULL: return -expm1(-pow(a / mean * exp(lgamma(1.0 + 1.0 / s->k)), s->k));
    case FL_SIZES_POWER:
        y = 0.5 * log(4.0 / PI * a * (fl_sizes_mean(s) / mean)) - log(s->dmin);
        if (y <= 0.0) return 0.0;
        if (y >= log_range(s)) return 1.0;
        return exp_integral(1.0 - s->beta, y) / exp_integral(1.0 - s->beta, log_range(s));
    case FL_SIZES_LIST:
        return s->cumulative_count[count_at_most(s, a * (fl_sizes_mean(s) / mean))] /
               s->cumulative_count[s->n];
    default: return a >= mean;
    }
}

double fl_sizes_ks_distance(const fl_sizes *s, double mean, int32_t n, const double *area)
{
    double most = 0.0;
    for (int32_t k = 0; k < n; k++) {
        /* just below area[k] the fraction is k / n, from it on at least (k + 1) / n */
        const double over = fl_sizes_cdf(s, mean, area[k] * (1.0 - FL_SIZES_SAME_TOL)) - (double)k / n;
        const double under = (k + 1.0) / n - fl_sizes_cdf(s, mean, area[k] * (1.0 + FL_SIZES_SAME_TOL));
        if (over > most) most = over;
        if (under > most) most = under;
    }
    return most;
}

void fl_sizes_free(fl_sizes *s)
{
    free(s->area);
    free(s->cumulative_count);
    free(s->cumulative_area);
    *s = (fl_sizes){0};
}
