/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include "base/fast_math.h"
#include "base/rng.h"

#define EPS 2.220446049250313e-16

static void exponential(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 1, FL_RNG_TEST);
    assert_true(fl_exp(0.0) == 1.0);
    for (long k = 0; k < test_times(100000); k++) {
        const double x = fl_rng_in(&g, -707.0, 709.0), y = fl_rng_in(&g, -1.0, 1.0);
        assert_near(fl_exp(x), exp(x), 2 * EPS);
        assert_near(fl_exp(y), exp(y), 2 * EPS);
    }
    assert_true(fl_exp(-708.5) == 0.0 && fl_exp(-INFINITY) == 0.0 && isinf(fl_exp(710.0)));
    assert_near(fl_exp(709.7), exp(709.7), 2 * EPS);
}

static void logarithm_and_power(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 2, FL_RNG_TEST);
    assert_true(fl_log(1.0) == 0.0);
    for (long k = 0; k < test_times(100000); k++) {
        const double x = pow(10.0, fl_rng_in(&g, -300.0, 300.0)), y = fl_rng_in(&g, 0.5, 2.0);
        assert_near(fl_log(x), log(x), 2 * EPS);
        assert_near(fl_log(y), log(y), 2 * EPS);
        const double a = fl_rng_in(&g, 0.0, 1.0), b = fl_rng_in(&g, 0.01, 3.0);
        assert_near(fl_pow(a, b), pow(a, b), 2 * EPS * (1.0 + fabs(b * log(a))));
    }
    assert_true(fl_pow(0.0, 0.5) == 0.0 && fl_pow(1.0, 0.3) == 1.0);
}

static void cosine_and_sine(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 3, FL_RNG_TEST);
    double c, s;
    fl_cos_sin(0.0, &c, &s);
    assert_true(c == 1.0 && s == 0.0);
    for (long k = 0; k < test_times(100000); k++) {
        const double size = pow(10.0, fl_rng_in(&g, -3.0, 6.0)), x = fl_rng_in(&g, -size, size);
        fl_cos_sin(x, &c, &s);
        assert_near_of(c, cos(x), 1.0, 2e-16);
        assert_near_of(s, sin(x), 1.0, 2e-16);
    }
    /* where the angle is a multiple of pi/2 to the last bit */
    for (int n = -100000; n <= 100000; n += 77) {
        const double x = n * 1.5707963267948966;
        fl_cos_sin(x, &c, &s);
        assert_near_of(c, cos(x), 1.0, 2e-16);
        assert_near_of(s, sin(x), 1.0, 2e-16);
    }
}

static void arc_tangent(void **state)
{
    static const double ZERO[2] = {0.0, -0.0};
    (void)state;
    fl_rng g = fl_rng_of(test_seed(), 4, FL_RNG_TEST);
    for (long k = 0; k < test_times(100000); k++) {
        const double size = pow(10.0, fl_rng_in(&g, -30.0, 30.0)), turn = fl_rng_in(&g, -4.0, 4.0);
        const double x = size * cos(turn), y = size * sin(turn) * (k % 2 ? 1.0 : 1e-7);
        assert_near_of(fl_atan2(y, x), atan2(y, x), 1.0, 4.5e-16);
        if (x > 0.0) assert_near(fl_atan2(y, x), atan2(y, x), 2 * EPS);
    }
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < 2; j++) {
            const double got = fl_atan2(ZERO[i], ZERO[j]), want = atan2(ZERO[i], ZERO[j]);
            assert_true(got == want && signbit(got) == signbit(want));
            assert_true(fl_atan2(ZERO[i], -2.0) == atan2(ZERO[i], -2.0));
            assert_true(fl_atan2(1.0, ZERO[j]) == atan2(1.0, ZERO[j]));
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(exponential), cmocka_unit_test(logarithm_and_power),
                                       cmocka_unit_test(cosine_and_sine), cmocka_unit_test(arc_tangent)};
    return cmocka_run_group_tests_name("fast_math", tests, NULL, NULL);
}
