/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/rainflow_matrix.h"
#include "support/near.h"

static void cells_by_hand(void **state)
{
    const fl_cycle cycle[] = {{4, 1, 1}, {10, 0, 0.5}, {5, -5, 0.5}, {4.5, 0, 0.5}, {10, 5, 1}, {0.5, 0, 1}};
    fl_err err = {0};
    fl_rainflow_matrix m;
    (void)state;
    assert_int_equal(fl_rainflow_matrix_make(&m, 2, 10.0, -5.0, 5.0, 6, cycle, &err), 0);
    assert_int_equal(m.cells, 3);
    /* 4, 4.5 and 0.5 about 0 to 1 */
    assert_int_equal(m.cell[0].range, 0);
    assert_int_equal(m.cell[0].mean, 1);
    assert_near(m.cell[0].cycles, 2.5, 0.0);
    /* a limit belongs to the class above it */
    assert_int_equal(m.cell[1].range, 1);
    assert_int_equal(m.cell[1].mean, 0);
    assert_near(m.cell[1].cycles, 0.5, 0.0);
    /* the upper ends belong to the last class */
    assert_int_equal(m.cell[2].range, 1);
    assert_int_equal(m.cell[2].mean, 1);
    assert_near(m.cell[2].cycles, 1.5, 0.0);
    assert_near(fl_rainflow_matrix_range(&m, 1), 5.0, 0.0);
    assert_near(fl_rainflow_matrix_mean(&m, 0), -5.0, 0.0);
    assert_near(fl_rainflow_matrix_mean(&m, 2), 5.0, 0.0);
    fl_rainflow_matrix_free(&m);
    assert_null(m.cell);
}

static void nothing_and_a_constant_mean(void **state)
{
    const fl_cycle same[] = {{2, 7, 1}, {1, 7, 1}};
    fl_err err = {0};
    fl_rainflow_matrix m;
    (void)state;
    assert_int_equal(fl_rainflow_matrix_make(&m, 20, 0.0, 3.0, 3.0, 0, NULL, &err), 0);
    assert_int_equal(m.cells, 0);
    fl_rainflow_matrix_free(&m);
    assert_int_equal(fl_rainflow_matrix_make(&m, 4, 2.0, 7.0, 7.0, 2, same, &err), 0);
    assert_int_equal(m.cells, 2);
    assert_int_equal(m.cell[0].range, 2);
    assert_int_equal(m.cell[1].range, 3);
    assert_int_equal(m.cell[1].mean, 0);
    fl_rainflow_matrix_free(&m);
}

/* Every cycle is in the cell whose printed limits hold it, and none is lost. */
static void random_cycles_are_in_their_cells(void **state)
{
    enum { N = 500 };
    (void)state;
    for (int run = 0; run < test_times(50); run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        const int32_t n = 1 + (int32_t)fl_rng_in(&g, 0.0, 30.0);
        const double R = fl_rng_in(&g, 0.1, 1e6), lo = fl_rng_in(&g, -1e6, 0.0), hi = lo + R;
        fl_cycle cycle[N];
        double sum = 0.0;
        fl_err err = {0};
        fl_rainflow_matrix m;
        for (int k = 0; k < N; k++) {
            /* often exactly on a limit */
            const double u = floor(fl_rng_in(&g, 0.0, n + 1.0)) / n, v = fl_rng_in(&g, 0.0, 1.0);
            cycle[k] = (fl_cycle){R * (k % 2 ? u : v), lo + (hi - lo) * (k % 3 ? u : v), k % 5 ? 1.0 : 0.5};
            if (cycle[k].range > R) cycle[k].range = R;
            if (cycle[k].mean > hi) cycle[k].mean = hi;
        }
        assert_int_equal(fl_rainflow_matrix_make(&m, n, R, lo, hi, N, cycle, &err), 0);
        for (int32_t c = 0; c < m.cells; c++) {
            const int32_t i = m.cell[c].range, j = m.cell[c].mean;
            double here = 0.0;
            for (int k = 0; k < N; k++) {
                const double x = cycle[k].range, y = cycle[k].mean;
                const int in_x = x >= fl_rainflow_matrix_range(&m, i) &&
                                 (x < fl_rainflow_matrix_range(&m, i + 1) || i == n - 1);
                const int in_y = y >= fl_rainflow_matrix_mean(&m, j) &&
                                 (y < fl_rainflow_matrix_mean(&m, j + 1) || j == n - 1);
                if (in_x && in_y) here += cycle[k].count;
            }
            assert_near(m.cell[c].cycles, here, 0.0);
            sum += here;
        }
        assert_near(sum, 400.0 + 50.0, 0.0);
        fl_rainflow_matrix_free(&m);
    }
}

static void allocation_failure_is_reported(void **state)
{
    const fl_cycle one = {1, 0, 1};
    fl_err err = {0};
    fl_rainflow_matrix m;
    (void)state;
    fl_alloc_fail_after(0);
    assert_int_equal(fl_rainflow_matrix_make(&m, 4, 1.0, 0.0, 0.0, 1, &one, &err), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(err.code, FL_SYSTEM);
    fl_rainflow_matrix_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_by_hand), cmocka_unit_test(nothing_and_a_constant_mean),
        cmocka_unit_test(random_cycles_are_in_their_cells), cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
