/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/pi.h"
#include "stat/oscillator.h"
#include "support/near.h"

/* Without damping (u, v/w) rotates by 2 atan(w h / 2) a step and keeps its length. */
static void step_is_a_rotation(void **state)
{
    const fl_oscillator o = {.frequency = 0.7};
    const double w = 2.0 * PI * 0.7;
    (void)state;
    for (double h = 0.001; h < 20.0; h *= 3.0) {
        fl_oscillator_state s = {.u = 1.0};
        fl_oscillator_set_acceleration(&o, 0.0, &s);
        fl_oscillator_step(&o, h, 0.0, &s);
        assert_near_of(atan2(-s.v / w, s.u), 2.0 * atan(0.5 * w * h), 1e-11, 1.0);
        assert_near(hypot(s.u, s.v / w), 1.0, 1e-11);
    }
}

static void a_state_of_rest_stays(void **state)
{
    const double edge[] = {0, 1, 1.5, 4}, same[] = {-3, -3, -3}, none[] = {0, 0, 0};
    const fl_oscillator o = {2.0, 0.05};
    fl_response r;
    fl_oscillator_state at[3];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_oscillator_solve(&o, 3, edge, same, &r, at, &err), 0);
    assert_near(r.largest, 3.0, 0.0);
    assert_near(r.t_largest, 0.0, 0.0);
    assert_near(r.largest_acceleration, 0.0, 0.0);
    assert_near(at[2].u, -3.0, 0.0);
    assert_near(r.mean, -3.0, 0.0);
    assert_near(r.std, 0.0, 0.0);
    assert_near(r.error, 0.0, 0.0);
    assert_int_equal(fl_oscillator_solve(&o, 3, edge, none, &r, NULL, &err), 0);
    assert_near(r.largest, 0.0, 0.0);
    assert_near(r.error, 0.0, 0.0);
}

/* A load that starts suddenly: 1 + exp(-z pi / sqrt(1 - z^2)) half a period later, and w^2 F at once. */
static void sudden_load(void **state)
{
    const double edge[] = {0, 1, 41}, x[] = {0, -2};
    const fl_oscillator o = {0.25, 0.05};
    const double w = 0.5 * PI, root = sqrt(1.0 - 0.05 * 0.05);
    fl_response r;
    fl_oscillator_state at[2];
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_oscillator_solve(&o, 2, edge, x, &r, at, &err), 0);
    assert_near(r.largest, 2.0 * (1.0 + exp(-0.05 * PI / root)), 1e-4);
    assert_true(r.error <= FL_OSCILLATOR_TOLERANCE);
    assert_near(r.t_largest, 1.0 + PI / (w * root), 1e-3);
    assert_near(r.largest_acceleration, 2.0 * w * w, 1e-12);
    assert_true(at[1].u < -1.0);
}

/* Equal loads in pieces are one load, for any division. */
static void splitting_a_load_changes_nothing(void **state)
{
    enum { N = 500 };
    const double whole[] = {0, 1, 6}, x[] = {0, 1};
    const fl_oscillator o = {1.3, 0.02};
    double edge[N + 2], y[N + 1];
    fl_response a, b;
    fl_err err = {0};
    (void)state;
    edge[0] = y[0] = 0.0;
    for (int k = 0; k <= N; k++) {
        edge[k + 1] = 1.0 + 5.0 * pow((double)k / N, 1.5);
        if (k < N) y[k + 1] = 1.0;
    }
    assert_int_equal(fl_oscillator_solve(&o, 2, whole, x, &a, NULL, &err), 0);
    assert_int_equal(fl_oscillator_solve(&o, N + 1, edge, y, &b, NULL, &err), 0);
    assert_near(a.largest, b.largest, 3.0 * FL_OSCILLATOR_TOLERANCE);
}

static void limits_and_lock_in(void **state)
{
    const double edge[] = {0, 1e9}, x[] = {1};
    const fl_oscillator fast = {10.0, 0.0}, o = {2.0, 0.0};
    fl_response r;
    fl_err err = {0};
    (void)state;
    assert_int_equal(fl_oscillator_solve(&fast, 1, edge, x, &r, NULL, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(
        err.text,
        "an oscillator of 10 Hz needs 3.2e+11 steps for the record of 1e+09 s, expected at most 1e+08");
    assert_true(fl_oscillator_near_frequency(&o, 1.85));
    assert_true(fl_oscillator_near_frequency(&o, 2.19));
    assert_false(fl_oscillator_near_frequency(&o, 2.25));
    assert_false(fl_oscillator_near_frequency(&o, 1.75));
    assert_false(fl_oscillator_near_frequency(&o, NAN));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(step_is_a_rotation),
                                       cmocka_unit_test(a_state_of_rest_stays), cmocka_unit_test(sudden_load),
                                       cmocka_unit_test(splitting_a_load_changes_nothing),
                                       cmocka_unit_test(limits_and_lock_in)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
