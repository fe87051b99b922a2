/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "stat/peaks.h"
#include "support/near.h"

static void expect_peaks(int32_t n, const double *x, double ratio, double threshold, int32_t count,
                         const int32_t *at)
{
    fl_err err = {0};
    fl_peaks p = {0};
    assert_int_equal(fl_peaks_rayleigh(n, x, ratio, threshold, &p, &err), 0);
    assert_int_equal(p.n, count);
    for (int32_t k = 0; k < count; k++) assert_int_equal(p.row[k], at[k]);
    fl_peaks_free(&p);
}

static void rule_by_hand(void **state)
{
    const double x[] = {0, 4, 3, 6, 1, 5, 2, 4, 0, 8, 0};
    (void)state;
    /* 4 | 3 | 6: 3 is not below 2; 6 | 1 | 5: below 2.5; 5 | 2 | 4: not below 2; then the zero before 8 */
    expect_peaks(11, x, 0.5, 0.0, 3, (int32_t[]){3, 5, 9});
    expect_peaks(11, x, 1.0, 0.0, 5, (int32_t[]){1, 3, 5, 7, 9});
    expect_peaks(11, x, 0.0, 0.0, 1, (int32_t[]){9}); /* a ratio of nothing separates nothing */
    expect_peaks(11, x, 0.5, 5.0, 2, (int32_t[]){3, 9});
    expect_peaks(11, x, 0.5, 8.0, 0, NULL);
}

/* The trough between two peaks counts although smaller maxima lie in it. */
static void small_maxima_do_not_hide_a_trough(void **state)
{
    const double x[] = {0, 10, 2, 3, 2.5, 9, 0}, merged[] = {0, 10, 6, 7, 6.5, 9, 0};
    (void)state;
    expect_peaks(7, x, 0.5, 0.0, 2, (int32_t[]){1, 5});
    expect_peaks(7, merged, 0.5, 0.0, 1, (int32_t[]){1});
    expect_peaks(7, x, 0.5, 5.0, 2, (int32_t[]){1, 5}); /* the same with the small ones under the threshold */
}

static void plateaus_and_ends(void **state)
{
    const double flat[] = {0, 5, 5, 5, 0, 0, 7, 7, 8, 0}, rising[] = {1, 2, 3}, ends[] = {9, 1, 9},
                 same[] = {2, 2, 2};
    (void)state;
    expect_peaks(10, flat, 0.5, 0.0, 2, (int32_t[]){1, 8});
    expect_peaks(3, rising, 0.5, 0.0, 0, NULL);
    expect_peaks(3, ends, 0.5, 0.0, 0, NULL);
    expect_peaks(3, same, 0.5, 0.0, 0, NULL);
    expect_peaks(1, same, 0.5, 0.0, 0, NULL);
    expect_peaks(3, (double[]){-3, -1, -3}, 0.5, 0.0, 0, NULL); /* not above the threshold of 0 */
}

/* Against the definition: neighbouring peaks are separate, and no larger maximum was dropped. */
static void random_records_obey_the_rule(void **state)
{
    enum { N = 300 };
    (void)state;
    for (int run = 0; run < 300; run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        fl_err err = {0};
        fl_peaks p = {0};
        double x[N];
        for (int k = 0; k < N; k++) x[k] = floor(fl_rng_in(&g, -2.0, 12.0));
        assert_int_equal(fl_peaks_rayleigh(N, x, 0.5, 0.0, &p, &err), 0);
        for (int32_t k = 0; k + 1 < p.n; k++) {
            double low = INFINITY, high = 0.0;
            for (int32_t j = p.row[k]; j <= p.row[k + 1]; j++) low = fmin(low, x[j]);
            assert_true(low < 0.5 * fmin(x[p.row[k]], x[p.row[k + 1]]));
            /* A maximum dropped between two peaks is no larger than the larger of them. */
            for (int32_t j = p.row[k]; j <= p.row[k + 1]; j++) high = fmax(high, x[j]);
            assert_near(high, fmax(x[p.row[k]], x[p.row[k + 1]]), 0.0);
        }
        fl_peaks_free(&p);
    }
}

static void allocation_failure_is_reported(void **state)
{
    const double x[] = {0, 1, 0};
    fl_err err = {0};
    fl_peaks p = {0};
    (void)state;
    fl_alloc_fail_after(0);
    assert_int_equal(fl_peaks_rayleigh(3, x, 0.5, 0.0, &p, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    fl_peaks_free(&p);
}

static void ranks_and_positions(void **state)
{
    const double x[] = {3.0, 9.0, 3.0, 4.0};
    int32_t rank[4];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_rank_descending(4, x, rank, &err), 0);
    assert_memory_equal(rank, ((int32_t[]){1, 3, 0, 2}), sizeof rank);
    assert_near(fl_plotting_position(1, 4), 0.2, 1e-16);
    assert_near(fl_plotting_position(4, 4), 0.8, 1e-16);
}

static void bins_hold_everything_once(void **state)
{
    fl_histogram h = {0};
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_histogram_make(&h, 4, 0.0, 8.0, &err), 0);
    for (int k = 0; k <= 8; k++) fl_histogram_add(&h, k, 0.5);
    fl_histogram_add(&h, -0.1, 1.0);
    fl_histogram_add(&h, 8.1, 1.0);
    assert_memory_equal(h.range, ((double[]){0, 2, 4, 6, 8}), 5 * sizeof(double));
    assert_memory_equal(h.bin, ((double[]){1, 1, 1, 1.5}), 4 * sizeof(double));
    fl_histogram_free(&h);
    assert_int_equal(fl_histogram_make(&h, 3, 50.0, 50.0, &err), 0);
    fl_histogram_add(&h, 50.0, 2.0);
    assert_memory_equal(h.bin, ((double[]){0, 2, 0}), 3 * sizeof(double));
    assert_true(h.range[0] < 50.0 && h.range[3] > 50.0);
    fl_histogram_free(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rule_by_hand),
                                       cmocka_unit_test(small_maxima_do_not_hide_a_trough),
                                       cmocka_unit_test(plateaus_and_ends),
                                       cmocka_unit_test(random_records_obey_the_rule),
                                       cmocka_unit_test(allocation_failure_is_reported),
                                       cmocka_unit_test(ranks_and_positions),
                                       cmocka_unit_test(bins_hold_everything_once)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
