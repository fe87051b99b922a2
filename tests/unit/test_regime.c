/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Regimes of ice-induced vibration. */
#include "stat/regime.h"
#include "support/near.h"
#include <math.h>
#include "base/pi.h"

enum { N = 1000 };
static const double MODE[3] = {0.2, 1.0, 2.2};

/* A window of 20 s with x' = a sin(2 pi f t), ice at 0.1 m/s. */
static fl_regime_window window_of(double a, double f, double breaks)
{
    static double load[N], x[N], v[N], ice[N], broken[N];
    fl_regime_window w;
    fl_err err = {0};
    for (int k = 0; k < N; k++) {
        const double t = 0.02 * (k + 0.5);
        load[k] = 3.0 + sin(t), ice[k] = 0.1, broken[k] = breaks;
        v[k] = a * sin(2 * PI * f * t), x[k] = 0.01 - a / (2 * PI * f) * cos(2 * PI * f * t);
    }
    const fl_regime_rows r = {N, 0.02, load, x, v, ice, breaks < 0 ? NULL : broken};
    assert_int_equal(fl_regime_classify(&w, &r, 0, N, MODE, 3, &err), 0);
    return w;
}

static void regimes_have_their_limits(void **state)
{
    (void)state;
    assert_int_equal(window_of(0.0, 1.0, 0).regime, FL_REGIME_CREEP);
    assert_int_equal(window_of(0.049, 1.0, 1).regime, FL_REGIME_CONTINUOUS);
    assert_int_equal(window_of(0.051, 1.0, 1).regime, FL_REGIME_LOCK_IN);
    assert_int_equal(window_of(0.159, 1.0, 1).regime, FL_REGIME_LOCK_IN);
    assert_int_equal(window_of(0.161, 1.0, 1).regime, FL_REGIME_INTERMITTENT);
    assert_int_equal(window_of(0.1, 1.5, 1).regime, FL_REGIME_INTERMITTENT);
    assert_int_equal(window_of(0.1, 1.0, -1).regime, FL_REGIME_LOCK_IN);
}

static void the_mode_is_the_near_one(void **state)
{
    (void)state;
    assert_int_equal(window_of(0.1, 1.09, 1).mode, 1);
    assert_int_equal(window_of(0.1, 1.11, 1).mode, -1);
    assert_int_equal(window_of(0.1, 2.0, 1).mode, 2);
    assert_int_equal(window_of(0.1, 0.19, 1).mode, 0);
    assert_int_equal(window_of(0.01, 1.0, 1).mode, -1); /* continuous */
}

static void numbers_are_those_of_a_sine(void **state)
{
    const fl_regime_window w = window_of(0.12, 1.0, 2);
    (void)state;
    assert_near(w.beta, 1.2, 1e-10);
    assert_near(w.peak, 1.2, 2e-3);
    assert_near(w.frequency, 1.0, 1e-3);
    assert_near(w.speed, 0.1, 1e-12);
    assert_near(w.x_mean, 0.01, 1e-10);
    assert_near(w.x_std, 0.12 / (2 * PI) / sqrt(2), 1e-10);
    assert_near(w.breaks, 2 * N, 0);
    for (double f = 0.21; f < 3.0; f *= 1.13) assert_near(window_of(0.1, f, 1).frequency, f, 4e-3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(regimes_have_their_limits),
                                       cmocka_unit_test(the_mode_is_the_near_one),
                                       cmocka_unit_test(numbers_are_those_of_a_sine)};
    return cmocka_run_group_tests_name("regime", tests, NULL, NULL);
}
