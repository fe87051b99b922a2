/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "support/near.h"
#include "base/array.h"
#include "base/rng.h"
#include "geom/hilbert_order.h"

enum { LAST = 65535 };

static void the_curve_has_its_ends(void **state)
{
    (void)state;
    assert_true(fl_hilbert_index(0, 0) == 0);
    assert_true(fl_hilbert_index(LAST, 0) == UINT32_MAX);
    assert_true(fl_hilbert_index(0, LAST) == UINT32_C(0x55555555));
    assert_true(fl_hilbert_index(LAST, LAST) == UINT32_C(0xaaaaaaaa));
}

/* Each of the first 4^6 indices is one cell in the corner of 2^6 squares a side, and the next cell is its
 * neighbour. */
static void the_curve_is_continuous_and_fills_the_square(void **state)
{
    (void)state;
    enum { SIDE = 64 };
    static int32_t x[SIDE * SIDE], y[SIDE * SIDE];
    static char taken[SIDE * SIDE];
    for (int32_t i = 0; i < SIDE * SIDE; i++) taken[i] = 0;
    for (uint32_t b = 0; b < SIDE; b++)
        for (uint32_t a = 0; a < SIDE; a++) {
            const uint32_t k = fl_hilbert_index(a, b);
            assert_true(k < SIDE * SIDE);
            assert_false(taken[k]);
            taken[k] = 1;
            x[k] = (int32_t)a;
            y[k] = (int32_t)b;
        }
    for (int32_t k = 1; k < SIDE * SIDE; k++)
        assert_int_equal(abs(x[k] - x[k - 1]) + abs(y[k] - y[k - 1]), 1);
}

/* The order is a permutation of all points. Its path through n random points of a unit square is short: the
 * shortest path is 0.7124 sqrt(n) (Beardwood, Halton & Hammersley, Proc. Camb. Phil. Soc. 55 (1959) 299),
 * this one is less than 1.5 times as long, and that in the input order is 0.52 n. */
static void the_path_through_points_is_short(void **state)
{
    (void)state;
    enum { N = 20000 };
    static fl_vec2 x[N];
    static int32_t order[N];
    static char seen[N];
    double way = 0.0;
    fl_err err = {0};
    for (int32_t i = 0; i < N; i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        x[i] = (fl_vec2){fl_rng_in(&g, -3, -2), fl_rng_in(&g, 7, 8)};
        seen[i] = 0;
    }
    assert_int_equal(fl_hilbert_order(N, x, order, &err), 0);
    for (int32_t k = 0; k < N; k++) {
        assert_in_range(order[k], 0, N - 1);
        assert_false(seen[order[k]]);
        seen[order[k]] = 1;
        if (k) way += hypot(x[order[k]].x - x[order[k - 1]].x, x[order[k]].y - x[order[k - 1]].y);
    }
    assert_true(way > 0.7 * sqrt(N));
    assert_true(way < 1.5 * 0.7124 * sqrt(N));
}

static void equal_points_keep_their_order(void **state)
{
    (void)state;
    const fl_vec2 one[3] = {{2, 2}, {2, 2}, {2, 2}}, two[4] = {{1, 0}, {0, 0}, {1, 0}, {0, 0}};
    int32_t order[4];
    fl_err err = {0};
    assert_int_equal(fl_hilbert_order(3, one, order, &err), 0);
    for (int32_t k = 0; k < 3; k++) assert_int_equal(order[k], k);
    assert_int_equal(fl_hilbert_order(4, two, order, &err), 0);
    assert_int_equal(order[0], 1);
    assert_int_equal(order[1], 3);
    assert_int_equal(order[2], 0);
    assert_int_equal(order[3], 2);
    assert_int_equal(fl_hilbert_order(0, NULL, order, &err), 0);
    for (long k = 0; k < 2; k++) {
        fl_alloc_fail_after(k);
        assert_int_equal(fl_hilbert_order(3, one, order, &err), -1);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, FL_SYSTEM);
        err = (fl_err){0};
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_curve_has_its_ends),
                                       cmocka_unit_test(the_curve_is_continuous_and_fills_the_square),
                                       cmocka_unit_test(the_path_through_points_is_short),
                                       cmocka_unit_test(equal_points_keep_their_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
