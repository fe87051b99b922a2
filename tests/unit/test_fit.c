/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/extreme.h"
#include "stat/fit.h"
#include "stat/return_level.h"
#include "stat/sample.h"
#include "support/near.h"

enum { N = 20, OVER = 12 };

/* Descending; reference values are of scipy 1.10 and of direct optimisation. */
static const double X[N] = {102.4, 91.2, 83.7, 80.9, 77.3, 73.1, 71.5, 68.8, 66.2, 64.5,
                            62.6,  60.3, 59.7, 58.4, 55.0, 53.6, 52.1, 49.9, 47.8, 45.2};

static fl_fit_work work;

static int setup(void **state)
{
    fl_err err = {0};
    (void)state;
    return fl_fit_work_make(&work, 1000, &err);
}

static int teardown(void **state)
{
    (void)state;
    fl_fit_work_free(&work);
    return 0;
}

static fl_dist fit_sample(int kind, int method, int32_t n, const double *x, double u)
{
    fl_dist d;
    assert_int_equal(fl_fit(&d, kind, method, n, x, u, &work), 1);
    return d;
}

static void likelihood_by_reference(void **state)
{
    fl_dist d = fit_sample(FL_WEIBULL, FL_FIT_LIKELIHOOD, N, X, 0.0);
    (void)state;
    assert_near(d.shape, 4.611384, 1e-5);
    assert_near(d.scale, 72.213023, 1e-7);
    assert_near(fl_fit_log_likelihood(&d, N, X), -82.993265, 1e-8);
    assert_near(fl_fit_kolmogorov(&d, N, X), 0.111858, 1e-5);
    assert_near(fl_fit_aic(&d, -82.993265), 169.98653, 1e-8);
    d = fit_sample(FL_LOGNORMAL, FL_FIT_LIKELIHOOD, N, X, 0.0);
    assert_near(d.shape, 0.215083, 1e-5);
    assert_near(log(d.scale), 4.169255, 1e-6);
    assert_near(fl_fit_log_likelihood(&d, N, X), -81.029230, 1e-8);
    d = fit_sample(FL_GUMBEL, FL_FIT_LIKELIHOOD, N, X, 0.0);
    assert_near(d.location, 59.390828, 1e-7);
    assert_near(d.scale, 11.591808, 1e-7);
    assert_near(fl_fit_log_likelihood(&d, N, X), -80.771475, 1e-8);
    d = fit_sample(FL_GEV, FL_FIT_LIKELIHOOD, N, X, 0.0);
    assert_near(d.location, 59.224661, 1e-4);
    assert_near(d.scale, 11.465538, 1e-4);
    assert_near(d.shape, 0.026732, 1e-4);
    assert_near(fl_fit_log_likelihood(&d, N, X), -80.764037, 1e-8);
    d = fit_sample(FL_GPD, FL_FIT_LIKELIHOOD, OVER, X, 60.0);
    assert_near(d.scale, 21.978632, 1e-4);
    assert_near(d.shape, -0.415871, 1e-4);
    assert_near(fl_fit_log_likelihood(&d, OVER, X), -44.090399, 1e-7);
}

static void moments_by_reference(void **state)
{
    double l[3];
    fl_dist d = fit_sample(FL_GUMBEL, FL_FIT_MOMENTS, N, X, 0.0);
    (void)state;
    assert_near(d.location, 59.403798, 1e-7);
    assert_near(d.scale, 11.791437, 1e-7);
    d = fit_sample(FL_GPD, FL_FIT_MOMENTS, OVER, X, 60.0);
    assert_near(d.scale, 18.721001, 1e-7);
    assert_near(d.shape, -0.230970, 1e-5);
    fl_fit_l_moments(N, X, l);
    assert_near(l[0], 66.21, 1e-14);
    assert_near(l[1], 8.648421, 1e-7);
    assert_near(l[2], 0.175755, 1e-5);
    d = fit_sample(FL_GUMBEL, FL_FIT_L_MOMENTS, N, X, 0.0);
    assert_near(d.location, 59.008060, 1e-7);
    assert_near(d.scale, 12.477034, 1e-7);
}

static void levels_by_reference(void **state)
{
    static const double tail[] = {0.1, 0.02, 0.01}, gumbel[] = {85.4767, 104.6214, 112.7149},
                        gev[] = {85.8182, 106.3790, 115.3480};
    const fl_dist g = fit_sample(FL_GUMBEL, FL_FIT_LIKELIHOOD, N, X, 0.0),
                  e = fit_sample(FL_GEV, FL_FIT_LIKELIHOOD, N, X, 0.0);
    const fl_dist p = {FL_GPD, 60.0, 15.0, 0.1};
    (void)state;
    for (int k = 0; k < 3; k++) {
        assert_near(fl_dist_upper_quantile(&g, tail[k]), gumbel[k], 1e-6);
        assert_near(fl_dist_upper_quantile(&e, tail[k]), gev[k], 1e-5);
    }
    assert_near(fl_dist_upper_quantile(&p, 1.0 / (11.0 * 100.0)), 212.1555, 1e-6);
}

/* Quantile, tail and cdf are consistent, and the density is the slope of the cdf, also through shape 0. */
static void functions_of_a_law_are_consistent(void **state)
{
    static const fl_dist law[] = {{FL_WEIBULL, 0, 2, 0.7},   {FL_WEIBULL, 0, 2, 3}, {FL_GUMBEL, 5, 2, 0},
                                  {FL_LOGNORMAL, 0, 3, 0.4}, {FL_GEV, 5, 2, 0.3},   {FL_GEV, 5, 2, -0.3},
                                  {FL_GEV, 5, 2, 1e-12},     {FL_GPD, 5, 2, 0.3},   {FL_GPD, 5, 2, -0.3},
                                  {FL_GPD, 5, 2, 0}};
    (void)state;
    for (size_t k = 0; k < sizeof law / sizeof *law; k++) {
        const fl_dist *d = &law[k];
        for (double tail = 0.9; tail > 1e-12; tail *= 0.3) {
            const double x = fl_dist_upper_quantile(d, tail), h = 1e-5 * d->scale;
            assert_near(fl_dist_survival(d, x), tail, 1e-8);
            if (tail < 1e-3) continue;
            assert_near(fl_dist_cdf(d, x), 1.0 - tail, 1e-10);
            assert_near((fl_dist_cdf(d, x + h) - fl_dist_cdf(d, x - h)) / (2.0 * h),
                        exp(fl_dist_log_density(d, x)), 1e-6);
        }
    }
    const fl_dist bounded = {FL_GEV, 5, 2, -0.5};
    assert_true(fl_dist_log_density(&bounded, 9.1) == -INFINITY);
    assert_near(fl_dist_cdf(&bounded, 9.1), 1.0, 0.0);
    assert_true(fl_dist_log_density(&law[0], -1.0) == -INFINITY);
}

/* L-moments and moments of a law's own quantiles recover it; likelihood is nowhere below theirs. */
static void fits_recover_their_law(void **state)
{
    static const fl_dist law[] = {{FL_WEIBULL, 0, 2e5, 1.4},   {FL_GUMBEL, 5e4, 2e4, 0},
                                  {FL_LOGNORMAL, 0, 3e5, 0.4}, {FL_GEV, 50, 7, 0.1},
                                  {FL_GEV, 50, 7, -0.2},       {FL_GPD, 50, 20, 0.05},
                                  {FL_GPD, 50, 20, -0.3}};
    enum { M = 1000 };
    static double x[M];
    (void)state;
    for (size_t k = 0; k < sizeof law / sizeof *law; k++) {
        double best = -INFINITY;
        for (int32_t j = 0; j < M; j++) x[j] = fl_dist_upper_quantile(&law[k], (M - j - 0.5) / M);
        for (int method = 0; method < FL_FIT_METHODS; method++) {
            const fl_dist d = fit_sample(law[k].kind, method, M, x, law[k].location);
            assert_near(d.scale, law[k].scale, 0.03);
            assert_near_of(d.shape, law[k].shape, 0.03, 1.0);
            assert_near_of(d.location, law[k].location, 0.01, law[k].scale);
            const double l = fl_fit_log_likelihood(&d, M, x);
            if (method == FL_FIT_LIKELIHOOD) best = l;
            assert_true(l <= best + 1e-9 * M);
        }
        /* The best law constrained to its own level is itself, and none with another level is better. */
        const fl_dist d = fit_sample(law[k].kind, FL_FIT_LIKELIHOOD, M, x, law[k].location);
        const double q = fl_dist_upper_quantile(&d, 1e-3);
        assert_near(fl_fit_constrained(&d, M, x, 1e-3, q, &work, NULL), best, 1e-9);
        assert_true(fl_fit_constrained(&d, M, x, 1e-3, 1.02 * q, &work, NULL) < best - 1e-3);
        assert_true(fl_fit_constrained(&d, M, x, 1e-3, 0.98 * q, &work, NULL) < best - 1e-3);
    }
}

static void degenerate_samples_are_refused(void **state)
{
    const double same[] = {3, 3, 3, 3, 3}, negative[] = {-1, 1, 2, 3, 4}, few[] = {1, 2};
    fl_dist d;
    (void)state;
    for (int kind = 0; kind < FL_DISTS; kind++) {
        for (int method = 0; method < FL_FIT_METHODS; method++) {
            assert_int_equal(fl_fit(&d, kind, method, 5, same, 0.0, &work), 0);
            assert_int_equal(fl_fit(&d, kind, method, 2, few, 0.0, &work), 0);
        }
    }
    assert_int_equal(fl_fit(&d, FL_WEIBULL, FL_FIT_LIKELIHOOD, 5, negative, 0.0, &work), 0);
    assert_int_equal(fl_fit(&d, FL_LOGNORMAL, FL_FIT_MOMENTS, 5, negative, 0.0, &work), 0);
    assert_int_equal(fl_fit(&d, FL_GPD, FL_FIT_LIKELIHOOD, 5, negative, 0.0, &work), 0);
    assert_int_equal(fl_fit(&d, FL_GUMBEL, FL_FIT_LIKELIHOOD, 5, negative, 0.0, &work), 1);
}

/* Random samples, some of them degenerate: a fit is a law with a finite likelihood, or it is refused. */
static void every_sample_gets_a_law_or_a_refusal(void **state)
{
    (void)state;
    for (int run = 0; run < 300; run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        const int32_t n = 1 + (int32_t)fl_rng_in(&g, 0.0, 30.0);
        const double unit = pow(10.0, fl_rng_in(&g, -20.0, 20.0));
        double x[40];
        for (int32_t k = 0; k < n; k++)
            x[k] =
                unit * (run % 3 == 0 ? floor(fl_rng_in(&g, 1.0, 4.0)) : exp(fl_rng_normal(&g) * (run % 7)));
        int32_t rank[40];
        double y[40];
        fl_err err = {0};
        assert_int_equal(fl_rank_descending(n, x, rank, &err), 0);
        for (int32_t k = 0; k < n; k++) y[k] = x[rank[k]];
        for (int kind = 0; kind < FL_DISTS; kind++) {
            for (int method = 0; method < FL_FIT_METHODS; method++) {
                fl_dist d;
                if (!fl_fit(&d, kind, method, n, y, 0.5 * y[n - 1], &work)) continue;
                assert_true(isfinite(d.location) && isfinite(d.scale) && isfinite(d.shape) && d.scale > 0.0);
                if (method == FL_FIT_LIKELIHOOD) assert_true(isfinite(fl_fit_log_likelihood(&d, n, y)));
            }
        }
    }
}

/* For a Gumbel law the interval of the level at F = e^-1, the location itself, is known to first order. */
static void intervals_enclose_the_estimate(void **state)
{
    (void)state;
    for (int kind = 0; kind < FL_DISTS; kind++) {
        const int32_t n = kind == FL_GPD ? OVER : N;
        const fl_dist d = fit_sample(kind, FL_FIT_LIKELIHOOD, n, X, 60.0);
        fl_return_level r[2] = {{.tail = 0.1}, {.tail = 0.01}};
        fl_goodness_of_fit g;
        fl_err err = {0};
        assert_int_equal(fl_compute_return_levels(&d, n, X, 2, r, &g, 99, 1, 0, &work, &err), 0);
        for (int k = 0; k < 2; k++) {
            assert_true(r[k].profile[0] < r[k].level && r[k].level < r[k].profile[1]);
            assert_true(r[k].bootstrap[0] < r[k].level && r[k].level < r[k].bootstrap[1]);
            if (kind == FL_GEV || kind == FL_GPD)
                assert_true(r[k].bootstrap[0] <= r[k].profile[0] && r[k].profile[1] <= r[k].bootstrap[1]);
            /* An end of the interval is where the likelihood ratio reaches its limit. */
            for (int e = 0; e < 2; e++) {
                const double l = fl_fit_constrained(&d, n, X, r[k].tail, r[k].profile[e], &work, NULL);
                const double t = gsl_cdf_tdist_Qinv(0.025, n - fl_dist_parameter_count(kind)),
                             cut = n * log1p(t * t / (n - fl_dist_parameter_count(kind)));
                if (isfinite(l)) assert_near(2.0 * (fl_fit_log_likelihood(&d, n, X) - l), cut, 1e-3);
                else assert_true(kind == FL_GPD && e == 0); /* no law with shape > -1/2 has a lower level */
            }
        }
        assert_true(r[1].profile[1] > r[0].profile[1]);
        assert_true(g.p_kolmogorov > 0.05 && g.p_kolmogorov <= 1.0 && g.p_anderson > 0.05);
    }
}

/* Values clustered at their upper end, where the likelihood of a GEV and of a GPD rises without bound: the
 * result is the law of shape -1/2 of which neither scale nor location can be improved. */
static void clustered_maxima_end_at_the_shape_bound(void **state)
{
    double x[N];
    (void)state;
    for (int k = 0; k < N; k++) x[k] = 100.0 + 10.0 * log((N - k) / (N + 1.0));
    for (int kind = FL_GEV; kind < FL_DISTS; kind++) {
        const fl_dist best = fit_sample(kind, FL_FIT_LIKELIHOOD, N, x, 60.0);
        const double largest = fl_fit_log_likelihood(&best, N, x);
        assert_near(best.shape, -0.5, 1e-12);
        assert_true(fl_dist_upper_quantile(&best, 1e-12) > x[0]);
        for (int k = 0; k < 8; k++) {
            fl_dist d = best;
            d.scale *= 1.0 + 0.01 * (k % 3 - 1);
            if (kind == FL_GEV) d.location += 0.01 * d.scale * (k / 3 - 1);
            if (d.scale != best.scale || d.location != best.location)
                assert_true(fl_fit_log_likelihood(&d, N, x) < largest);
        }
    }
}

static void anderson_darling_by_hand(void **state)
{
    /* F = 1/4, 3/4 under an exponential law of mean 1 */
    const fl_dist d = {FL_WEIBULL, 0.0, 1.0, 1.0};
    const double x[] = {-log(0.75), -log(0.25)};
    (void)state;
    assert_near(fl_fit_anderson(&d, 2, x), -2.0 - 0.5 * (2.0 * log(0.25) + 6.0 * log(0.75)), 1e-14);
    assert_near(fl_fit_kolmogorov(&d, 2, x), 0.25, 1e-14);
}

static void expect_rows(const fl_peaks *p, int32_t n, const int32_t *at)
{
    assert_int_equal(p->n, n);
    for (int32_t k = 0; k < n; k++) assert_int_equal(p->row[k], at[k]);
}

static void clusters_and_blocks(void **state)
{
    const double x[] = {5, 7, 1, 8, 2, 2, 2, 6, 9, 0}, edge[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    fl_peaks p = {0};
    fl_err err = {0};
    int32_t whole;
    (void)state;
    assert_int_equal(fl_sample_peaks_over_threshold(10, x, edge, 4.0, 0.0, &p, &err), 0);
    expect_rows(&p, 3, (int32_t[]){1, 3, 8});
    assert_int_equal(fl_sample_peaks_over_threshold(10, x, edge, 4.0, 3.0, &p, &err),
                     0); /* 3 s between rows 3 and 7 */
    expect_rows(&p, 2, (int32_t[]){3, 8});
    assert_int_equal(fl_sample_peaks_over_threshold(10, x, edge, 4.0, 3.5, &p, &err), 0);
    expect_rows(&p, 1, (int32_t[]){8});
    assert_int_equal(fl_sample_peaks_over_threshold(10, x, edge, 9.0, 0.0, &p, &err), 0);
    expect_rows(&p, 0, NULL);
    assert_int_equal(fl_sample_block_maxima(10, x, edge, 3.0, &p, &whole, &err), 0);
    expect_rows(&p, 3, (int32_t[]){1, 3, 8});
    assert_int_equal(whole, 3);
    assert_int_equal(fl_sample_block_maxima(10, x, edge, 20.0, &p, &whole, &err), 0);
    expect_rows(&p, 0, NULL);
    fl_alloc_fail_after(0);
    fl_peaks_free(&p);
    assert_int_equal(fl_sample_block_maxima(10, x, edge, 3.0, &p, NULL, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    fl_peaks_free(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(likelihood_by_reference),
                                       cmocka_unit_test(moments_by_reference),
                                       cmocka_unit_test(levels_by_reference),
                                       cmocka_unit_test(functions_of_a_law_are_consistent),
                                       cmocka_unit_test(fits_recover_their_law),
                                       cmocka_unit_test(degenerate_samples_are_refused),
                                       cmocka_unit_test(every_sample_gets_a_law_or_a_refusal),
                                       cmocka_unit_test(intervals_enclose_the_estimate),
                                       cmocka_unit_test(clustered_maxima_end_at_the_shape_bound),
                                       cmocka_unit_test(anderson_darling_by_hand),
                                       cmocka_unit_test(clusters_and_blocks)};
    return cmocka_run_group_tests(tests, setup, teardown);
}
