/* SPDX-License-Identifier: GPL-3.0-or-later */
/* verify_summary.c -- exact sums on data that are known to be hard, quantiles from histogram classes
 * against those of the values, and the coverage of the confidence interval of an ensemble.  NIST:
 * Statistical Reference Datasets, univariate summary statistics, NumAcc1 to NumAcc4.  Their certified
 * values hold for the decimal numbers; doubles differ by half a unit in the last place, which bounds the
 * attainable error. */
#include <float.h>
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include "base/rng.h"
#include "stat/log_histogram.h"
#include "stat/descriptive_stats.h"
#include "stat/mean_interval.h"
#include "stat/exact_sum.h"
#include "support/verify.h"

enum { NIST = 1001 };

static void moments_of(int32_t n, const double *x, const double *w, double out[4])
{
    fl_exact_sum s[5] = {{0}};
    fl_err err = {0};
    for (int32_t k = 0; k < n; k++)
        if (fl_exact_add_powers(s, w ? w[k] : 1.0, x[k], &err)) abort();
    fl_exact_moments(s, out);
    for (int k = 0; k < 5; k++) fl_exact_free(&s[k]);
}

/* The deviation with n - 1 from running sums of x and x^2 in doubles, as a counter-example. */
static double naive_deviation(int32_t n, const double *x)
{
    double sum = 0.0, squares = 0.0;
    for (int32_t k = 0; k < n; k++) {
        sum += x[k];
        squares += x[k] * x[k];
    }
    const double v = (squares - sum * sum / n) / (n - 1);
    return v > 0.0 ? sqrt(v) : 0.0;
}

static void nist_data(void)
{
    static const double base[] = {1.2, 1000000.2, 10000000.2};
    static const char *const name[][2] = {
        {"NumAcc2 mean", "NumAcc2 std"}, {"NumAcc3 mean", "NumAcc3 std"}, {"NumAcc4 mean", "NumAcc4 std"}};
    const double three[] = {10000001, 10000003, 10000002};
    double x[NIST], out[4];
    moments_of(3, three, NULL, out);
    verify_row("NIST", "NumAcc1 mean", out[0], 10000002.0, 0.0, VERIFY_REL);
    verify_row("NIST", "NumAcc1 std", out[1] * sqrt(1.5), 1.0, 2.0 * DBL_EPSILON, VERIFY_REL);
    for (int k = 0; k < 3; k++) {
        x[0] = base[k];
        for (int i = 1; i < NIST; i++) x[i] = base[k] + (i % 2 ? -0.1 : 0.1);
        moments_of(NIST, x, NULL, out);
        /* Each value has an error of at most half a unit of the largest. */
        const double off = base[k] * DBL_EPSILON;
        verify_row("NIST", name[k][0], out[0], base[k], off, VERIFY_ABS);
        verify_row("NIST", name[k][1], out[1] * sqrt((double)NIST / (NIST - 1)), 0.1, 2.0 * off + DBL_EPSILON,
                   VERIFY_ABS);
        verify_note("      running sums in doubles: std %.10g", naive_deviation(NIST, x));
    }
}

/* A mean of 10^k times the deviation: two passes in doubles lose digits, exact sums none. */
static void large_mean(void)
{
    enum { N = 1000 };
    double worst = 0.0, two_pass = 0.0, x[N], w[N], near[4], far[4];
    for (int e = 0; e <= 12; e += 4) {
        for (int i = 0; i < N; i++) {
            fl_rng g = fl_rng_of(3, i, FL_RNG_TEST);
            /* Multiples of 2^-10, so that the shifted values are exactly the same ones. */
            x[i] = floor(1024.0 * (exp(fl_rng_normal(&g)))) / 1024.0;
            w[i] = 0.01;
        }
        moments_of(N, x, w, near);
        for (int i = 0; i < N; i++) x[i] += pow(10.0, e);
        moments_of(N, x, w, far);
        for (int k = 1; k < 4; k++) worst = fmax(worst, fabs(far[k] / near[k] - 1.0));
        fl_descriptive_stats d;
        fl_compute_moments(N, x, w, &d);
        two_pass = fmax(two_pass, fabs(d.std / near[1] - 1.0));
    }
    verify_below("shift", "std, skew, kurtosis of values + 10^12 [rel]", worst, 4.0 * DBL_EPSILON);
    verify_note("      std by two passes in doubles: error %.1e", two_pass);
}

static double value_of(fl_rng *g, int law)
{
    if (law == 0) return fl_rng_normal(g) + 1.0;
    if (law == 1) return -log(1.0 - fl_rng_unit(g));  /* Weibull, k = 1 */
    if (law == 2) return exp(2.0 * fl_rng_normal(g)); /* log-normal */
    return fl_rng_unit(g) < 0.6 ? 0.0
                                : 1e3 * pow(-log(1.0 - fl_rng_unit(g)), 2.0); /* mostly without contact */
}

static void quantiles(void)
{
    static const double p[] = {0.05, 0.5, 0.9, 0.99, 0.999};
    enum { P = 5 };
    const int32_t n = verify_quick() ? 200000 : 2000000;
    double *x = malloc((size_t)n * sizeof *x), q[P], worst = 0.0;
    fl_err err = {0};
    if (!x) abort();
    for (int law = 0; law < 4; law++) {
        fl_log_histogram c = {0};
        fl_log_bin *sorted;
        double lo = INFINITY, hi = -INFINITY;
        for (int32_t k = 0; k < n; k++) {
            fl_rng g = fl_rng_of(5 + (uint64_t)law, k, FL_RNG_TEST);
            x[k] = value_of(&g, law);
            lo = fmin(lo, x[k]);
            hi = fmax(hi, x[k]);
            if (fl_log_histogram_add(&c, fl_log_bin_key(x[k]), 1, fl_fixed_time_of(0.01), &err)) abort();
        }
        if (fl_log_histogram_sort(&c, &sorted, &err) || fl_compute_quantiles(n, x, NULL, P, p, q, &err))
            abort();
        for (int j = 0; j < P; j++) {
            const double got = fl_log_histogram_quantile(c.n, sorted, p[j], lo, hi);
            worst = fmax(worst, q[j] == got ? 0.0 : fabs(got - q[j]) / fabs(q[j]));
        }
        free(sorted);
        fl_log_histogram_free(&c);
    }
    free(x);
    verify_below("class", "quantiles of four laws from classes [rel]", worst, 1.0 / 128);
    verify_note("      %d values a law, p = 0.05 to 0.999; a class is 1/128 wide", n);
}

/* A load of a run, less the mean of its law, from laws of growing skewness. */
static double load_of_run(fl_rng *g, int law)
{
    double sum = 0.0;
    switch (law) {
    case 0: return fl_rng_normal(g);
    case 1: return -log(-log(1.0 - fl_rng_unit(g))) - 0.57721566490153286061; /* Gumbel, skewness 1.1 */
    case 2:
        for (int k = 0; k < 4; k++) sum -= log(1.0 - fl_rng_unit(g)); /* gamma of order 4, 1 */
        return sum - 4.0;
    case 3: return -log(1.0 - fl_rng_unit(g)) - 1.0;               /* exponential, 2 */
    default: return exp(0.6 * fl_rng_normal(g)) - exp(0.5 * 0.36); /* log-normal, 2.3 */
    }
}

/* Shares of ensembles of n runs whose interval contains the mean, and of those whose interval by Student's
 * law does. */
static void coverage(int n, int law, int many, double *in_interval, double *student)
{
    const double t = gsl_cdf_tdist_Qinv(0.025, n - 1);
    double x[64];
    *in_interval = *student = 0.0;
    for (int k = 0; k < many; k++) {
        fl_rng g = fl_rng_of(11 + (uint64_t)(16 * n + law), k, FL_RNG_TEST);
        for (int i = 0; i < n; i++) x[i] = load_of_run(&g, law);
        const fl_mean_interval e = fl_mean_interval_of(n, x);
        *in_interval += (e.low <= 0.0 && e.high >= 0.0) / (double)many;
        *student += (fabs(e.mean) <= t * e.std / sqrt(n)) / (double)many;
    }
}

static void intervals(void)
{
    static const char *const law[] = {"normal", "Gumbel", "gamma", "exponential", "log-normal"};
    static const int runs[] = {3, 5, 10, 20, 50};
    const int many = verify_quick() ? 10000 : 100000;
    double in_interval, student;
    char what[80];
    coverage(2, 0, many, &in_interval, &student);
    /* A share of many trials has the deviation sqrt(0.05 0.95 / many); the tolerance is four of them. */
    verify_row("cover", "95 % interval of 2 normal runs", in_interval, 0.95, 4.0 * sqrt(0.05 * 0.95 / many),
               VERIFY_ABS);
    for (int k = 0; k < 5; k++) {
        for (int j = 0; j < 5; j++) {
            coverage(runs[j], k, many, &in_interval, &student);
            snprintf(what, sizeof what, "95 %% interval of %d %s runs", runs[j], law[k]);
            /* Three values have no known skewness: only that the interval is wider than Student's. */
            if (runs[j] > 3) verify_row("cover", what, in_interval, 0.95, 0.02, VERIFY_ABS);
            else verify_below("cover", what, student - in_interval, 0.0);
            verify_note("      held %.4f, by Student's law %.4f", in_interval, student);
        }
    }
}

int main(void)
{
    verify_begin("summaries and ensembles");
    nist_data();
    large_mean();
    quantiles();
    intervals();
    return verify_end();
}
