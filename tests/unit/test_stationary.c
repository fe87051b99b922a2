/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include <stdlib.h>
#include "base/pi.h"
#include "stat/stationary.h"

enum { ROWS = 2000 };

/* A normal number, by the sum of twelve uniform ones. */
static double normal_draw(uint64_t *state)
{
    double sum = -6.0;
    for (int k = 0; k < 12; k++) {
        *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        sum += (double)(*state >> 11) * 0x1p-53;
    }
    return sum;
}

/* Correlated rows, rho(k) = 0.8^k, deviation 1, about a mean that goes from a to b. */
static void fill_drifting(double *x, double a, double b, uint64_t seed)
{
    uint64_t state = seed;
    double at = 0.0;
    for (int32_t k = -100; k < ROWS; k++) {
        at = 0.8 * at + 0.6 * normal_draw(&state);
        if (k >= 0) x[k] = at + a + (b - a) * k / ROWS;
    }
}

static fl_stationarity judge(int32_t n, const double *x, double span)
{
    fl_stationarity s;
    fl_err err = {0};
    assert_int_equal(fl_stationarity_make(&s, n, x, span, &err), 0);
    return s;
}

/* 2000 rows with tau = 4.5 rows have 222 independent values: halves scatter by 0.095 each, so a mean of 0.5
 * that stays is above the tenth, and fails in one case of twenty. */
static void a_steady_record_is_seldom_said_to_move(void **state)
{
    double x[ROWS];
    int moves = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 300; seed++) {
        fill_drifting(x, 0.5, 0.5, 7919 * seed);
        const fl_stationarity s = judge(ROWS, x, 400.0);
        assert_true(s.judged);
        moves += s.moves;
    }
    assert_true(moves > 3 && moves < 33);
}

/* From 0.5 to 1.5 the halves are 0.5 apart, 3.7 standard errors: two tests together find nearly all. */
static void a_rise_is_found(void **state)
{
    double x[ROWS], apart = 0.0;
    int moves = 0;
    (void)state;
    for (uint64_t seed = 1; seed <= 100; seed++) {
        fill_drifting(x, 0.5, 1.5, 104729 * seed);
        const fl_stationarity s = judge(ROWS, x, 400.0);
        apart += s.apart / 100.0;
        moves += s.moves;
    }
    assert_true(moves > 90);
    assert_near(apart, 0.5 / sqrt(2.0 * 9.0 / ROWS * 2.0), 0.15);
}

/* A sine of whole periods in each half stays, whatever its amplitude; one that stands on a step moves. */
static void halves_are_compared(void **state)
{
    double x[ROWS], y[ROWS];
    (void)state;
    for (int k = 0; k < ROWS; k++) {
        x[k] = 1.0 + 5.0 * sin(2.0 * PI * k / 50.0);
        y[k] = x[k] + (k >= ROWS / 2 ? 3.0 : 0.0);
    }
    const fl_stationarity s = judge(ROWS, x, 100.0), t = judge(ROWS, y, 100.0);
    assert_true(!s.moves && t.moves && s.judged);
    assert_near(t.mean[0], 1.0, 1e-12);
    assert_near(t.mean[1], 4.0, 1e-12);
}

static void an_event_is_not_judged(void **state)
{
    double x[ROWS];
    (void)state;
    for (int k = 0; k < ROWS; k++) x[k] = exp(-0.5 * (k - 1500.0) * (k - 1500.0) / (300.0 * 300.0));
    assert_true(!judge(ROWS, x, 10.0).judged && !judge(ROWS, x, 10.0).moves);
    assert_true(!judge(3, x, 10.0).judged);
    for (int k = 0; k < ROWS; k++) x[k] = 2.0;
    const fl_stationarity s = judge(ROWS, x, 10.0);
    assert_true(s.judged && !s.moves && s.apart == 0.0 && s.trend == 0.0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_steady_record_is_seldom_said_to_move),
        cmocka_unit_test(a_rise_is_found),
        cmocka_unit_test(halves_are_compared),
        cmocka_unit_test(an_event_is_not_judged),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
