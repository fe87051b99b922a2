/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include <stdlib.h>
#include "stat/integral_time.h"

enum { N = 200000 };

/* A normal number, by the sum of twelve uniform ones. */
static double normal_number(uint64_t *state)
{
    double sum = -6.0;
    for (int k = 0; k < 12; k++) {
        *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        sum += (double)(*state >> 11) * 0x1p-53;
    }
    return sum;
}

/* An autoregressive record of first order: rho(k) = r^k. */
static void fill(double *x, int32_t n, double r, uint64_t seed)
{
    uint64_t state = seed;
    double at = 0.0;
    for (int32_t k = -1000; k < n; k++) {
        at = r * at + sqrt(1.0 - r * r) * normal_number(&state);
        if (k >= 0) x[k] = at;
    }
}

static fl_record_mean mean_of(int32_t n, const double *x, double span, int one_sign)
{
    fl_record_mean m;
    fl_err err = {0};
    double mean = 0.0, square = 0.0;
    for (int32_t k = 0; k < n; k++) mean += x[k] / n;
    for (int32_t k = 0; k < n; k++) square += (x[k] - mean) * (x[k] - mean) / n;
    assert_int_equal(fl_record_mean_make(&m, n, x, span, mean, sqrt(square), one_sign, &err), 0);
    return m;
}

static void tau_is_that_of_the_process(void **state)
{
    static const double R[] = {0.0, 0.5, 0.9, 0.98};
    double *x = malloc(N * sizeof *x);
    (void)state;
    /* One estimate scatters by sqrt(2 (2 W + 1) / n), W the rows up to the first zero of the correlation,
     * about 6 tau: 0.16 and 0.38 for the last two; the mean of forty by a sixth of that. */
    for (int k = 0; k < 4; k++) {
        double mean = 0.0;
        for (uint64_t seed = 1; seed <= 40; seed++) {
            fill(x, 8000, R[k], 7919 * seed);
            mean += mean_of(8000, x, 800.0, 0).tau / 40.0;
        }
        assert_near(mean, 0.1 * (0.5 + R[k] / (1.0 - R[k])), k == 3 ? 0.15 : 0.08);
    }
    fill(x, N, 0.99, 3); /* averaged over groups of 25 rows */
    assert_near(mean_of(N, x, N, 0).tau, 0.5 + 0.99 / 0.01, 0.15);
    free(x);
}

/* Nineteen intervals in twenty hold the true mean. */
static void intervals_cover_the_mean(void **state)
{
    double x[2000];
    int inside = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 400; seed++) {
        fill(x, 2000, 0.8, seed * 977);
        const fl_record_mean m = mean_of(2000, x, 2000.0, 0);
        inside += m.low < 0.0 && m.high > 0.0;
    }
    assert_true(inside > 360 && inside < 396);
}

static void a_constant_is_known(void **state)
{
    const double x[4] = {3.0, 3.0, 3.0, 3.0};
    (void)state;
    const fl_record_mean m = mean_of(4, x, 4.0, 1);
    assert_true(m.tau == 0.0 && m.low == 3.0 && m.high == 3.0 && m.n == 4.0);
}

static void an_interval_keeps_the_sign_of_its_values(void **state)
{
    const double x[6] = {0.1, 0.0, 0.0, 9.0, 0.0, 0.2};
    double y[6];
    (void)state;
    for (int k = 0; k < 6; k++) y[k] = -x[k];
    const fl_record_mean a = mean_of(6, x, 6.0, 0), b = mean_of(6, x, 6.0, 1), c = mean_of(6, y, 6.0, 1);
    assert_true(a.low < 0.0 && b.low > 0.0 && b.high == a.high);
    assert_true(c.high == -b.low && c.low == -b.high);
    assert_true(fl_interval_end(2.0, 1.0) == 1.0 && fl_interval_end(-2.0, 1.0) == -1.0);
    assert_near(fl_interval_end(2.0, 2.0), 2.0 * exp(-1.0), 1e-15);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tau_is_that_of_the_process),
        cmocka_unit_test(intervals_cover_the_mean),
        cmocka_unit_test(a_constant_is_known),
        cmocka_unit_test(an_interval_keeps_the_sign_of_its_values),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
