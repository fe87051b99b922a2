/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdlib.h>
#include "base/rng.h"
#include "stat/descriptive_stats.h"
#include "support/near.h"

/* Twenty loads; the reference values are of scipy 1.10. */
static const double SAMPLE[] = {52.1, 60.3, 47.8, 71.5, 66.2, 58.4,  83.7, 49.9, 55.0, 91.2,
                                62.6, 77.3, 68.8, 45.2, 59.7, 102.4, 73.1, 64.5, 53.6, 80.9};
enum { N = sizeof SAMPLE / sizeof *SAMPLE };

static void known_moments(void **state)
{
    fl_descriptive_stats d;
    (void)state;
    fl_compute_moments(N, SAMPLE, NULL, &d);
    assert_int_equal(d.n, N);
    assert_near(d.time, N, 0.0);
    assert_near(d.mean, 66.21, 1e-14);
    assert_near(d.std, 14.740180, 1e-7);
    assert_near(d.std_sample, 15.123105, 1e-7);
    assert_near(d.skew, 0.722765, 1e-6);
    assert_near(d.min, 45.2, 0.0);
    assert_near(d.max, 102.4, 0.0);
    assert_int_equal(d.at_min, 13);
    assert_int_equal(d.at_max, 15);
}

/* A row that lasts twice as long counts as two rows. Halving all rows changes nothing. */
static void weight_is_repetition(void **state)
{
    double x[3 * N], w[N], p[5] = {0.0, 0.25, 0.5, 0.9, 1.0}, q[5], qr[5];
    int32_t m = 0;
    fl_descriptive_stats d, dr;
    fl_err err = {0};
    (void)state;
    for (int k = 0; k < N; k++) {
        w[k] = 1.0 + k % 3;
        for (int j = 0; j <= k % 3; j++) x[m++] = SAMPLE[k];
    }
    fl_compute_moments(N, SAMPLE, w, &d);
    fl_compute_moments(m, x, NULL, &dr);
    assert_near(d.mean, dr.mean, 1e-14);
    assert_near(d.std, dr.std, 1e-13);
    assert_near(d.skew, dr.skew, 1e-12);
    assert_near(d.kurtosis, dr.kurtosis, 1e-11);
    for (int k = 0; k < N; k++) w[k] = 0.01;
    fl_compute_moments(N, SAMPLE, w, &d);
    fl_compute_moments(N, SAMPLE, NULL, &dr);
    assert_near(d.std_sample, dr.std_sample, 1e-13);
    assert_int_equal(fl_compute_quantiles(N, SAMPLE, w, 5, p, q, &err), 0);
    assert_int_equal(fl_compute_quantiles(N, SAMPLE, NULL, 5, p, qr, &err), 0);
    for (int k = 0; k < 5; k++) assert_near(q[k], qr[k], 1e-12);
}

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void equal_weights_are_gsl_quantiles(void **state)
{
    double x[101];
    (void)state;
    for (int n = 1; n <= 101; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        fl_err err = {0};
        double p = fl_rng_unit(&g), q;
        for (int k = 0; k < n; k++) x[k] = floor(fl_rng_in(&g, -20.0, 20.0));
        assert_int_equal(fl_compute_quantiles(n, x, NULL, 1, &p, &q, &err), 0);
        qsort(x, (size_t)n, sizeof *x, compare_doubles);
        assert_near_of(q, gsl_stats_quantile_from_sorted_data(x, 1, (size_t)n, p), 1e-13, 20.0);
    }
}

static void ends_of_the_quantiles_are_the_extremes(void **state)
{
    const double x[] = {3.0, -1.0, 2.0}, w[] = {0.1, 7.0, 0.4}, p[] = {0.0, 1.0, 0.5};
    double q[3];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_compute_quantiles(3, x, w, 3, p, q, &err), 0);
    assert_near(q[0], -1.0, 0.0);
    assert_near(q[1], 3.0, 0.0);
    /* middles 3.5, 7.2, 7.45; halfway is 5.475 */
    assert_near(q[2], -1.0 + 3.0 * (5.475 - 3.5) / 3.7, 1e-14);
}

static void normal_sample(void **state)
{
    enum { MANY = 200000 };
    double *x = malloc(MANY * sizeof *x);
    fl_rng g = fl_rng_of(test_seed(), 0, FL_RNG_TEST);
    fl_descriptive_stats d;
    (void)state;
    assert_non_null(x);
    for (int k = 0; k < MANY; k++) x[k] = 1e6 + fl_rng_normal(&g);
    fl_compute_moments(MANY, x, NULL, &d);
    free(x);
    /* five standard errors: 1, sqrt(1/2), sqrt(6), sqrt(24) over sqrt(n) */
    assert_near_of(d.mean - 1e6, 0.0, 5.0 / sqrt(MANY), 1.0);
    assert_near_of(d.std, 1.0, 5.0 * sqrt(0.5 / MANY), 1.0);
    assert_near_of(d.skew, 0.0, 5.0 * sqrt(6.0 / MANY), 1.0);
    assert_near_of(d.kurtosis, 0.0, 5.0 * sqrt(24.0 / MANY), 1.0);
}

static void constant_has_no_shape(void **state)
{
    double x[1000];
    fl_descriptive_stats d;
    (void)state;
    for (int k = 0; k < 1000; k++) x[k] = 0.1;
    fl_compute_moments(1000, x, NULL, &d);
    assert_near(d.mean, 0.1, 1e-15);
    assert_near(d.std, 0.0, 0.0);
    assert_true(isnan(d.skew) && isnan(d.kurtosis));
    x[500] += 1e-17; /* not a spread, but rounding */
    fl_compute_moments(1000, x, NULL, &d);
    assert_near(d.std, 0.0, 0.0);
    fl_compute_moments(1, x, NULL, &d);
    assert_near(d.mean, 0.1, 0.0);
    assert_near(d.std, 0.0, 0.0);
    assert_true(isnan(d.std_sample));
}

static void mean_of_the_highest_share(void **state)
{
    const double x[] = {9.0, 6.0, 5.0, 3.0, 2.0, 1.0};
    (void)state;
    assert_near(fl_mean_of_highest(6, x, 1.0 / 3.0), 7.5, 1e-15);
    assert_near(fl_mean_of_highest(6, x, 1.0), 26.0 / 6.0, 1e-15);
    assert_near(fl_mean_of_highest(6, x, 0.1), 9.0, 0.0);                        /* at least one */
    assert_near(fl_mean_of_highest(6, x, 0.25), (9.0 + 0.5 * 6.0) / 1.5, 1e-15); /* one and a half */
    assert_near(fl_mean_of_highest(1, x, 1.0 / 3.0), 9.0, 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_moments),
                                       cmocka_unit_test(weight_is_repetition),
                                       cmocka_unit_test(equal_weights_are_gsl_quantiles),
                                       cmocka_unit_test(ends_of_the_quantiles_are_the_extremes),
                                       cmocka_unit_test(normal_sample),
                                       cmocka_unit_test(constant_has_no_shape),
                                       cmocka_unit_test(mean_of_the_highest_share)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
