/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <gsl/gsl_cdf.h>
#include <math.h>
#include "base/rng.h"
#include "stat/mean_interval.h"
#include "support/near.h"

static void known_intervals(void **state)
{
    const double one[] = {5}, two[] = {1, 3}, even[] = {-3, -1, 0, 1, 3}, same[] = {2, 2, 2};
    (void)state;
    fl_mean_interval e = fl_mean_interval_of(1, one);
    assert_near(e.mean, 5.0, 0.0);
    assert_true(isnan(e.std) && isnan(e.low) && isnan(e.high));
    e = fl_mean_interval_of(2, two); /* Student's point for one degree of freedom is 12.7062 */
    assert_near(e.low, 2.0 - 12.706204736174698, 1e-12);
    assert_near(e.high, 2.0 + 12.706204736174698, 1e-12);
    e = fl_mean_interval_of(5, even); /* no skewness: Student's, 2.77645, with s^2 = 5 */
    assert_near(e.high, 2.7764451051977987, 1e-12);
    assert_near(e.low, -e.high, 1e-12);
    e = fl_mean_interval_of(3, same);
    assert_near(e.low, 2.0, 0.0);
    assert_near(e.high, 2.0, 0.0);
}

/* The upper end of a sample with a long upper tail satisfies its defining equation. */
static void ends_solve_the_equation(void **state)
{
    const double x[] = {1, 2, 2, 3, 4, 12};
    const int n = 6;
    double m3 = 0.0;
    (void)state;
    const fl_mean_interval e = fl_mean_interval_of(n, x);
    for (int k = 0; k < n; k++) m3 += pow(x[k] - e.mean, 3.0);
    const double t = gsl_cdf_tdist_Qinv(0.025, n - 1), unit = e.std / sqrt(n);
    const double a = n * m3 / (pow(e.std, 3.0) * (n - 1) * (n - 2)) / sqrt(n), T = (e.mean - e.high) / unit;
    assert_true(e.high > e.mean + t * unit);
    assert_near(e.low, e.mean - t * unit, 1e-12); /* the short tail needs no more than Student's */
    assert_near(T + a * T * T / 3.0 + a * a * T * T * T / 27.0 + a / 6.0, -t, 1e-10);
}

/* Loads in other units or of the other sign have the interval in those units, or mirrored. */
static void scale_shift_and_sign(void **state)
{
    (void)state;
    for (int trial = 0; trial < test_times(500); trial++) {
        fl_rng g = fl_rng_of(test_seed(), trial, FL_RNG_TEST);
        const int n = 3 + (int)fl_rng_in(&g, 0.0, 20.0);
        const double scale = exp(fl_rng_in(&g, -20.0, 20.0)), shift = fl_rng_in(&g, -5.0, 5.0);
        double x[32], y[32];
        for (int k = 0; k < n; k++) {
            x[k] = -log(1.0 - fl_rng_unit(&g));
            y[k] = -scale * (x[k] + shift);
        }
        const fl_mean_interval a = fl_mean_interval_of(n, x), b = fl_mean_interval_of(n, y);
        assert_true(a.low <= a.mean && a.mean <= a.high && isfinite(a.low) && isfinite(a.high));
        assert_near_of(b.low, -scale * (a.high + shift), 1e-9, scale * (fabs(a.high) + 5.0));
        assert_near_of(b.high, -scale * (a.low + shift), 1e-9, scale * (fabs(a.low) + 5.0));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(known_intervals),
                                       cmocka_unit_test(ends_solve_the_equation),
                                       cmocka_unit_test(scale_shift_and_sign)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
