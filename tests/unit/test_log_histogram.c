/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include "base/rng.h"
#include "stat/log_histogram.h"
#include "stat/descriptive_stats.h"
#include "support/near.h"

static fl_err err;

static void bins_have_stated_limits(void **state)
{
    static const double x[] = {0.0,    -0.0,    1.0,    -1.0,    1.5,  3.999, 1e100, -1e100, DBL_MIN,
                               5e-324, -5e-324, 1e-310, -1e-310, 1e-5, 127.0, 128.0, -0.1,   DBL_MAX / 2};
    (void)state;
    assert_int_equal(fl_log_bin_key(0.0), fl_log_bin_key(-0.0));
    assert_true(fl_log_bin_lower(fl_log_bin_key(1.0)) == 1.0);
    assert_true(fl_log_bin_upper(fl_log_bin_key(1.0)) == 1.0 + 1.0 / 128);
    for (size_t k = 0; k < sizeof x / sizeof *x; k++) {
        const int32_t key = fl_log_bin_key(x[k]);
        const double a = fl_log_bin_lower(key), b = fl_log_bin_upper(key);
        assert_true(x[k] > 0.0 ? a <= x[k] && x[k] < b : a < x[k] && x[k] <= b);
        /* Neighbouring bins leave no gap, and the limits identify the bin. */
        assert_true(fl_log_bin_lower(key + 1) == b && fl_log_bin_upper(key - 1) == a);
        assert_int_equal(fl_log_bin_key(0.5 * a + 0.5 * b), key);
        if (fabs(x[k]) >= DBL_MIN) assert_true(b - a <= fabs(x[k]) / 128 * (1.0 + 1.0 / 128));
    }
    for (long k = 0; k < test_times(20000); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double p = fl_rng_normal(&g) * pow(10.0, fl_rng_in(&g, -3, 3)),
                     q = p + fabs(p) * fl_rng_unit(&g);
        assert_true(fl_log_bin_key(p) <= fl_log_bin_key(q));
    }
}

static void sums_of_fixed_times(void **state)
{
    fl_fixed_time sum = {0, 0};
    (void)state;
    for (int k = 0; k < 1000; k++) sum = fl_fixed_time_add(sum, fl_fixed_time_of(0.01));
    assert_near(fl_fixed_time_seconds(sum), 10.0, 1e-15);
    assert_true(fl_fixed_time_seconds(fl_fixed_time_of(FL_LOG_HISTOGRAM_LONGEST)) ==
                FL_LOG_HISTOGRAM_LONGEST);
    assert_true(fl_fixed_time_seconds(fl_fixed_time_of(0x1p-64)) == 0x1p-64);
    assert_true(fl_fixed_time_seconds(fl_fixed_time_of(0x1p-65)) == 0.0);
}

/* Quantiles and means of the highest share against those of the values themselves, within the error of the
 * header. */
static void quantiles(void **state)
{
    enum { N = 5000 };
    static double x[N], w[N];
    const double p[] = {0.0, 0.01, 0.3, 0.5, 0.9, 0.99, 1.0};
    double q[7];
    (void)state;
    for (int run = 0; run < 10; run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        fl_log_histogram c = {0}, half[2] = {{0}, {0}};
        fl_log_bin *sorted = NULL;
        double lo = INFINITY, hi = -INFINITY;
        for (int k = 0; k < N; k++) {
            x[k] = (run % 2 ? 1.0 : -5.0) + 3.0 * fl_rng_normal(&g);
            w[k] = fl_rng_in(&g, 0.5, 1.0);
            lo = fmin(lo, x[k]);
            hi = fmax(hi, x[k]);
            assert_int_equal(
                fl_log_histogram_add(&half[k % 2], fl_log_bin_key(x[k]), 1, fl_fixed_time_of(w[k]), &err), 0);
        }
        assert_int_equal(fl_log_histogram_merge(&c, &half[1], &err), 0);
        assert_int_equal(fl_log_histogram_merge(&c, &half[0], &err), 0);
        assert_int_equal(fl_log_histogram_sort(&c, &sorted, &err), 0);
        int64_t n = 0;
        for (int32_t k = 0; k < c.n; k++) n += sorted[k].n;
        assert_int_equal(n, N);
        assert_int_equal(fl_compute_quantiles(N, x, w, 7, p, q, &err), 0);
        for (int j = 0; j < 7; j++) {
            /* Where values are sparse, the exact quantile is itself a choice within their spacing. */
            const double got = fl_log_histogram_quantile(c.n, sorted, p[j], lo, hi),
                         spacing = j % 6 ? 0.05 : 0.0;
            assert_near_of(got, q[j], 1.0, fabs(q[j]) / 128 + spacing);
        }
        assert_near(fl_log_histogram_quantile(c.n, sorted, 1.0, lo, hi), hi, 0.0);
        free(sorted);
        for (int k = 0; k < 2; k++) fl_log_histogram_free(&half[k]);
        fl_log_histogram_free(&c);
        assert_null(c.slot);
    }
}

static void means_of_the_highest_share(void **state)
{
    const double x[] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 100}, down[] = {100, 9, 8, 7, 6, 5, 4, 3, 2, 1};
    const double share[] = {1.0, 1.0 / 3.0, 0.1, 0.01};
    fl_log_histogram c = {0};
    fl_log_bin *sorted = NULL;
    (void)state;
    for (int k = 0; k < 10; k++)
        assert_int_equal(fl_log_histogram_add(&c, fl_log_bin_key(x[k]), 1, (fl_fixed_time){0, 0}, &err), 0);
    assert_int_equal(fl_log_histogram_sort(&c, &sorted, &err), 0);
    for (int j = 0; j < 4; j++)
        assert_near(fl_log_histogram_mean_highest(c.n, sorted, share[j], 1.0, 100.0),
                    fl_mean_of_highest(10, down, share[j]), 1.0 / 256);
    free(sorted);
    fl_log_histogram_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bins_have_stated_limits),
                                       cmocka_unit_test(sums_of_fixed_times), cmocka_unit_test(quantiles),
                                       cmocka_unit_test(means_of_the_highest_share)};
    return cmocka_run_group_tests_name("log_histogram", tests, NULL, NULL);
}
