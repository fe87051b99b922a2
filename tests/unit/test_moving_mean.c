/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "stat/moving_mean.h"
#include "support/near.h"

enum { N = 400 };

static void windows_by_hand(void **state)
{
    const double edge[] = {0, 1, 2, 3, 5}, x[] = {1, 4, 2, 8};
    double y[4];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_moving_mean(4, edge, x, 1.0, y, &err), 0);
    assert_near(y[0], 1.0, 1e-14);
    assert_near(y[1], 4.0, 1e-14);
    assert_near(y[3], 8.0, 1e-14);
    assert_int_equal(fl_moving_mean(4, edge, x, 3.0, y, &err), 0);
    assert_near(y[0], 2.5, 1e-14);               /* 0 .. 2 */
    assert_near(y[1], 7.0 / 3.0, 1e-14);         /* 0 .. 3 */
    assert_near(y[2], (4 + 2 + 8) / 3.0, 1e-14); /* 1 .. 4 */
    assert_near(y[3], (0.5 * 2 + 16) / 2.5, 1e-14);
    assert_int_equal(fl_moving_mean(4, edge, x, 5.0, y, &err), 0);
    assert_near(y[2], (1 + 4 + 2 + 16) / 5.0, 1e-14);
}

/* A sine comes out with the gain sin(M a) / (M sin a) for windows of M rows, a = pi f h, and no shift. */
static void sine_has_its_gain(void **state)
{
    double edge[N + 1], x[N], y[N];
    fl_err err = {0};
    (void)state;
    for (int k = 0; k <= N; k++) edge[k] = 0.05 * k;
    for (int M = 1; M < 40; M += 2) {
        const double a = 2.0 * PI * 1.3 * 0.05, gain = sin(0.5 * M * a) / (M * sin(0.5 * a));
        for (int k = 0; k < N; k++) x[k] = 7.0 + sin(a * k);
        assert_int_equal(fl_moving_mean(N, edge, x, 0.05 * M, y, &err), 0);
        for (int k = 20; k < N - 20; k++) assert_near_of(y[k], 7.0 + gain * sin(a * k), 1e-12, 7.0);
    }
}

/* Against the sum over every overlap, for random intervals; a constant of any size stays to its last
 * digits. */
static void random_records_match_the_overlap_sum(void **state)
{
    (void)state;
    for (int run = 0; run < test_times(50); run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        double edge[N + 1] = {0}, x[N], y[N];
        fl_err err = {0};
        for (int k = 0; k < N; k++) {
            edge[k + 1] = edge[k] + fl_rng_in(&g, 0.001, 1.0);
            x[k] = fl_rng_in(&g, -5.0, 9.0);
        }
        const double T = edge[N] * fl_rng_in(&g, 1e-4, 1.0);
        assert_int_equal(fl_moving_mean(N, edge, x, T, y, &err), 0);
        for (int k = 0; k < N; k++) {
            const double c = 0.5 * (edge[k] + edge[k + 1]);
            double sum = 0.0, time = 0.0;
            for (int i = 0; i < N; i++) {
                const double part = fmin(edge[i + 1], c + 0.5 * T) - fmax(edge[i], c - 0.5 * T);
                if (part > 0.0) {
                    sum += part * x[i];
                    time += part;
                }
            }
            assert_near_of(y[k], sum / time, 1e-10, 9.0);
        }
        for (int k = 0; k < N; k++) x[k] = 1e12;
        assert_int_equal(fl_moving_mean(N, edge, x, T, y, &err), 0);
        for (int k = 0; k < N; k++) assert_near(y[k], 1e12, 1e-15);
    }
}

static void invalid_limits_are_reported(void **state)
{
    const double edge[] = {0, 1, 2}, x[] = {1, 2};
    double y[2];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_moving_mean(2, edge, x, 2.1, y, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text,
                        "a moving mean over 2.1 s, expected more than 0 and at most the 2 s of the record");
    fl_alloc_fail_after(0);
    err = (fl_err){0};
    assert_int_equal(fl_moving_mean(2, edge, x, 1.0, y, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(windows_by_hand), cmocka_unit_test(sine_has_its_gain),
                                       cmocka_unit_test(random_records_match_the_overlap_sum),
                                       cmocka_unit_test(invalid_limits_are_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
