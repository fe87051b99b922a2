/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "body/relaxation.h"
#include "member/arc_length.h"

static void the_root_lies_along_the_path(void **state)
{
    (void)state;
    double x = 0.0;
    /* (x - 3)(x + 2) = x2 - x - 6 */
    assert_int_equal(fl_arc_root(1.0, -0.5, -6.0, 1.0, 0.0, &x), 0);
    assert_true(fabs(x - 3.0) < 1e-15);
    assert_int_equal(fl_arc_root(1.0, -0.5, -6.0, -1.0, 0.0, &x), 0);
    assert_true(fabs(x + 2.0) < 1e-15);
    assert_int_equal(fl_arc_root(1.0, -0.5, -6.0, 0.0, -5.0, &x), 0);
    assert_true(fabs(x + 2.0) < 1e-15);
}

static void a_small_root_does_not_cancel(void **state)
{
    (void)state;
    double x = 0.0;
    /* x2 + 2e8 x - 1: the larger root is 5e-9 (1 - 2.5e-17) */
    assert_int_equal(fl_arc_root(1.0, 1e8, -1.0, 1.0, 0.0, &x), 0);
    assert_true(fabs(x / 5e-9 - 1.0) < 1e-15);
}

static void no_root_leaves_the_value(void **state)
{
    (void)state;
    double x = 7.0;
    assert_int_equal(fl_arc_root(1.0, 0.0, 1.0, 1.0, 0.0, &x), 1);
    assert_int_equal(fl_arc_root(0.0, 1.0, 1.0, 1.0, 0.0, &x), 1);
    assert_int_equal(fl_arc_root(1.0, NAN, 1.0, 1.0, 0.0, &x), 1);
    assert_true(x == 7.0);
}

static void parabola_and_cubic_find_their_own_extremes(void **state)
{
    (void)state;
    const double s[4] = {0.0, 1.0, 2.5, 3.0};
    double y[4], z[4], at;
    for (int k = 0; k < 4; k++) {
        y[k] = 5.0 - 2.0 * (s[k] - 1.7) * (s[k] - 1.7);
        z[k] = s[k] * s[k] * s[k] / 3.0 - 4.0 * s[k]; /* least at 2 */
    }
    assert_true(fabs(fl_arc_parabola(s + 1, y + 1, &at) - 5.0) < 1e-13 && fabs(at - 1.7) < 1e-13);
    assert_true(fabs(fl_arc_cubic(s, z, &at) + 16.0 / 3.0) < 1e-12 && fabs(at - 2.0) < 1e-12);
}

/* lambda = s, P0.d = s2: the work from 1 to 2 is 14/3. */
static void work_of_a_parabola_is_exact(void **state)
{
    (void)state;
    const double s[3] = {0.0, 1.0, 2.0}, x[3] = {0.0, 1.0, 2.0}, y[3] = {0.0, 1.0, 4.0};
    assert_true(fabs(fl_arc_work(s, x, y) - 14.0 / 3.0) < 1e-14);
}

/* m x'' = -k x from x = 1: what each damping has left after so many steps. */
static double left_after(enum fl_relaxation_kind kind, double c, int steps)
{
    const double k = 0.01;
    fl_relaxation r = fl_relaxation_start(kind, c);
    double x = 1.0, v = 0.0, before = 0.0;
    for (int n = 0; n < steps; n++) {
        const double f = k * x;
        if (n > 0) fl_relaxation_adapt(&r, v * (f - before), v * v, 1.0);
        before = f;
        v = fl_relaxation_c1(&r) * v - fl_relaxation_c2(&r) * f;
        x += v;
        if (fl_relaxation_peak(&r, 0.5 * v * v)) v = 0.0;
    }
    return fabs(x);
}

static void every_damping_brings_an_oscillator_to_rest(void **state)
{
    (void)state;
    /* A period is 63 steps: a quarter of it stops kinetic damping near rest each time; 0.7 of the critical
     * damping falls by exp(-0.7 0.1) a step; viscous damping c by exp(-c/2). */
    assert_true(left_after(FL_RELAXATION_KINETIC, 0.0, 200) < 1e-6);
    assert_true(left_after(FL_RELAXATION_ADAPTIVE, 0.0, 200) < 1e-4);
    assert_true(left_after(FL_RELAXATION_VISCOUS, 0.02, 2000) < 1e-7);
    assert_true(left_after(FL_RELAXATION_VISCOUS, 1e-9, 400) > 0.1 ||
                left_after(FL_RELAXATION_VISCOUS, 1e-9, 416) > 0.1);
}

/* Without the half step a start from rest at every second step would double the work of the force. */
static void the_first_step_takes_half(void **state)
{
    (void)state;
    fl_relaxation r = fl_relaxation_start(FL_RELAXATION_KINETIC, 0.0);
    assert_true(fl_relaxation_c2(&r) == 0.5);
    assert_int_equal(fl_relaxation_peak(&r, 1.0), 0);
    assert_true(fl_relaxation_c2(&r) == 1.0);
    assert_int_equal(fl_relaxation_peak(&r, 0.5), 1);
    assert_true(fl_relaxation_c2(&r) == 0.5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_root_lies_along_the_path),
                                       cmocka_unit_test(a_small_root_does_not_cancel),
                                       cmocka_unit_test(no_root_leaves_the_value),
                                       cmocka_unit_test(parabola_and_cubic_find_their_own_extremes),
                                       cmocka_unit_test(work_of_a_parabola_is_exact),
                                       cmocka_unit_test(every_damping_brings_an_oscillator_to_rest),
                                       cmocka_unit_test(the_first_step_takes_half)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
