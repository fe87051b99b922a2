/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/rng.h"
#include "stat/rainflow.h"
#include "support/near.h"

static fl_rainflow f;

static void count_cycles(int rule, int residue, int32_t n, const double *x)
{
    fl_err err = {0};
    assert_int_equal(fl_rainflow_count(&f, rule, residue, n, x, &err), 0);
}

static double cycles_of(double range)
{
    double sum = 0.0;
    for (int32_t k = 0; k < f.cycles; k++)
        if (f.cycle[k].range == range) sum += f.cycle[k].count;
    return sum;
}

static double all_cycles(void)
{
    double sum = 0.0;
    for (int32_t k = 0; k < f.cycles; k++) sum += f.cycle[k].count;
    return sum;
}

static double miner_sum(double m)
{
    const fl_sn_curve sn = {m, 1.0, 0.0, 0.0};
    double sum = 0.0;
    for (int32_t k = 0; k < f.cycles; k++) sum += fl_sn_damage(&sn, f.cycle[k].range, f.cycle[k].count);
    return sum;
}

/* The example of ASTM E1049-85, figure 6. */
static const double ASTM[] = {-2, 1, -3, 5, -1, 3, -4, 4, -2};

static void example_of_astm(void **state)
{
    (void)state;
    count_cycles(FL_RAINFLOW_ASTM, FL_RESIDUE_HALF, 9, ASTM);
    assert_near(cycles_of(3.0), 0.5, 0.0);
    assert_near(cycles_of(4.0), 1.5, 0.0);
    assert_near(cycles_of(6.0), 0.5, 0.0);
    assert_near(cycles_of(8.0), 1.0, 0.0);
    assert_near(cycles_of(9.0), 0.5, 0.0);
    assert_near(all_cycles(), 4.0, 0.0);
    assert_near(miner_sum(3.0), 1094.0, 1e-13);
    assert_near(miner_sum(4.0), 8449.0, 1e-13);
    assert_near(miner_sum(5.0), 67838.0, 1e-13);
    assert_near(fl_rainflow_equivalent(f.cycles, f.cycle, 3.0), cbrt(1094.0 / 4.0), 1e-14);
}

/* By hand: -1 3 is the only inner range; the rest goes 1 up, down, up ... with ranges 3 4 8 9 8 6. */
static void example_by_four_points(void **state)
{
    (void)state;
    count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_NONE, 9, ASTM);
    assert_int_equal(f.cycles, 1);
    assert_near(f.cycle[0].range, 4.0, 0.0);
    assert_near(f.cycle[0].mean, 1.0, 0.0);
    /* Half cycles for the residue: the same counts as by ASTM. */
    count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_HALF, 9, ASTM);
    assert_near(cycles_of(4.0), 1.5, 0.0);
    assert_near(miner_sum(5.0), 67838.0, 1e-13);
    /* Repeated: from the highest point 5 around to itself, 5 -4 4 -3 5, with the range 3 of 1 -2 inside. */
    count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_REPEAT, 9, ASTM);
    assert_near(cycles_of(9.0), 1.0, 0.0);
    assert_near(cycles_of(7.0), 1.0, 0.0);
    assert_near(cycles_of(4.0), 1.0, 0.0);
    assert_near(cycles_of(3.0), 1.0, 0.0);
    assert_near(all_cycles(), 4.0, 0.0);
}

static void records_without_cycles(void **state)
{
    const double same[] = {2, 2, 2}, up[] = {1, 2, 2, 5}, two[] = {1, 4}, flat[] = {0, 3, 3, 0, 0, 3};
    (void)state;
    for (int rule = 0; rule < FL_RAINFLOW_RULES; rule++) {
        count_cycles(rule, FL_RESIDUE_HALF, 0, NULL);
        assert_int_equal(f.cycles, 0);
        count_cycles(rule, FL_RESIDUE_HALF, 3, same);
        assert_int_equal(f.cycles, 0);
        count_cycles(rule, FL_RESIDUE_HALF, 4, up);
        assert_near(cycles_of(4.0), 0.5, 0.0);
        assert_int_equal(f.cycles, 1);
        count_cycles(rule, FL_RESIDUE_HALF, 2, two);
        assert_near(cycles_of(3.0), 0.5, 0.0);
        count_cycles(rule, FL_RESIDUE_HALF, 6, flat);
        assert_near(cycles_of(3.0), 1.5, 0.0);
        count_cycles(rule, FL_RESIDUE_REPEAT, 3, same);
        assert_int_equal(f.cycles, 0);
    }
    assert_near(fl_rainflow_equivalent(0, NULL, 3.0), 0.0, 0.0);
}

/* With half cycles for the residue both rules count the same ranges. Every range is counted once: their sum
 * is half the total variation of the record. A closed record repeated gives as many whole cycles. */
static void random_records(void **state)
{
    enum { N = 200 };
    (void)state;
    for (int run = 0; run < 200; run++) {
        fl_rng g = fl_rng_of(test_seed(), run, FL_RNG_TEST);
        double x[N + 1], way = 0.0, sum = 0.0, astm;
        for (int k = 0; k < N; k++) x[k] = floor(fl_rng_in(&g, 0.0, 30.0));
        x[N] = x[0];
        for (int k = 0; k < N; k++) way += fabs(x[k + 1] - x[k]);
        count_cycles(FL_RAINFLOW_ASTM, FL_RESIDUE_HALF, N + 1, x);
        for (int32_t k = 0; k < f.cycles; k++) sum += f.cycle[k].range * f.cycle[k].count;
        assert_near(sum, 0.5 * way, 1e-13);
        astm = miner_sum(3.0);
        count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_HALF, N + 1, x);
        assert_near(miner_sum(3.0), astm, 1e-13);
        count_cycles(FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_REPEAT, N + 1, x);
        sum = 0.0;
        for (int32_t k = 0; k < f.cycles; k++) {
            sum += f.cycle[k].range * f.cycle[k].count;
            assert_near(f.cycle[k].count, 1.0, 0.0);
        }
        assert_near(sum, 0.5 * way, 1e-13);
    }
}

static void damage_lines(void **state)
{
    const fl_sn_curve one = {3.0, 1e12, 0.0, 0.0}, two = {3.0, 1e12, 5.0, 10.0},
                      cut = {3.0, 1e12, INFINITY, 10.0};
    (void)state;
    assert_near(fl_sn_damage(&one, 100.0, 2e6), 2.0, 1e-14);
    assert_near(fl_sn_damage(&two, 100.0, 2e6), 2.0, 1e-14);
    assert_near(fl_sn_damage(&two, 10.0, 1e9), 1.0, 1e-14);
    assert_near(fl_sn_damage(&two, 5.0, 32e9), 1.0, 1e-14);
    assert_near(fl_sn_damage(&cut, 9.9, 1e9), 0.0, 0.0);
    assert_near(fl_sn_damage(&one, 0.0, 1e9), 0.0, 0.0);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_rainflow_free(&f);
    for (long n = 0;; n++) {
        fl_err err = {0};
        fl_alloc_fail_after(n);
        const int rc = fl_rainflow_count(&f, FL_RAINFLOW_FOUR_POINT, FL_RESIDUE_REPEAT, 9, ASTM, &err);
        fl_alloc_fail_after(-1);
        fl_rainflow_free(&f);
        if (rc == 0) break;
        assert_int_equal(err.code, FL_SYSTEM);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(example_of_astm),        cmocka_unit_test(example_by_four_points),
        cmocka_unit_test(records_without_cycles), cmocka_unit_test(random_records),
        cmocka_unit_test(damage_lines),           cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
