/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "base/pi.h"
#include "pack/grading.h"

static fl_grading law(const char *text, int dim)
{
    fl_grading g = {0};
    fl_err err = {0};
    assert_int_equal(fl_grading_law(&g, text, dim, &err), 1);
    return g;
}

/* F(d) = (d1^-2 - d^-2)/(d1^-2 - d2^-2) of spheres that are uniform by mass; P is straight. */
static void uniform_by_mass_has_its_number_curve(void **state)
{
    (void)state;
    fl_grading g = law("uniform:1,2", 3);
    for (double d = 1.05; d < 2.0; d += 0.1) {
        assert_near(fl_grading_mass(&g, 3, d), d - 1.0, 1e-14);
        const double f = (1.0 - 1.0 / (d * d)) / (1.0 - 0.25);
        assert_near(fl_grading_count(&g, 3, d), f, 1e-14);
        assert_near(fl_grading_quantile(&g, 3, f), d, 1e-13);
    }
    assert_near(fl_grading_number(&g, 3) * 6.0 / PI, 0.375 * 6.0 / PI, 1e-14);
    fl_grading_free(&g);
}

static void uniform_by_number_is_straight_in_number(void **state)
{
    (void)state;
    for (int dim = 2; dim <= 3; dim++) {
        fl_grading g = law("uniform:2,6,number", dim);
        for (double d = 2.5; d < 6.0; d += 0.5)
            assert_near(fl_grading_count(&g, dim, d), (d - 2.0) / 4.0, 1e-13);
        fl_grading_free(&g);
    }
}

static void fuller_is_a_power(void **state)
{
    (void)state;
    fl_grading g = law("fuller:0.5,1,9", 3);
    assert_near(fl_grading_mass(&g, 3, 4.0), (2.0 - 1.0) / (3.0 - 1.0), 1e-14);
    assert_near(fl_grading_mass(&g, 3, 0.5), 0.0, 0.0);
    assert_near(fl_grading_mass(&g, 3, 10.0), 1.0, 1e-15);
    fl_grading_free(&g);
}

/* A piece of less than half a body gives its volume to the next finer one; the total stays. */
static void volume_is_kept_where_a_sieve_is_empty(void **state)
{
    (void)state;
    fl_grading_piece piece[] = {{1, 2, 0.9, 0}, {20, 30, 0.1, 0}};
    const fl_grading g = {.pieces = 2, .piece = piece};
    fl_err err = {0};
    double *d, sum = 0.0;
    int32_t n, empty;
    assert_int_equal(fl_grading_draw(&g, 3, PI / 6.0, 5000.0, 0, &d, &n, &empty, &err), 0);
    assert_int_equal(empty, 1);
    for (int32_t k = 0; k < n; k++) {
        sum += PI / 6.0 * d[k] * d[k] * d[k];
        if (k) assert_true(d[k] <= d[k - 1]);
    }
    assert_near(sum, 5000.0, 1e-9);
    free(d);
}

static void single_sizes_and_numbers_are_drawn(void **state)
{
    (void)state;
    fl_grading g = law("single:0.25", 2);
    fl_err err = {0};
    double *d;
    int32_t n, empty;
    assert_int_equal(fl_grading_draw(&g, 2, PI / 4.0, 1.0, 7, &d, &n, &empty, &err), 0);
    assert_int_equal(n, 7);
    for (int32_t k = 0; k < n; k++) assert_near(d[k], 0.25, 0.0);
    free(d);
    /* by volume: the whole number of bodies nearest to it, scaled to it */
    assert_int_equal(fl_grading_draw(&g, 2, PI / 4.0, 1.0, 0, &d, &n, &empty, &err), 0);
    assert_int_equal(n, 20);
    assert_near(n * PI / 4.0 * d[0] * d[0], 1.0, 1e-12);
    free(d);
    assert_int_equal(fl_grading_draw(&g, 2, PI / 4.0, 1e-3, 0, &d, &n, &empty, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_grading_free(&g);
}

static void laws_that_are_none_are_told_apart(void **state)
{
    (void)state;
    fl_grading g = {0};
    fl_err err = {0};
    assert_int_equal(fl_grading_law(&g, "curve.tsv", 3, &err), 0);
    static const char *const BAD[] = {"uniform:",         "uniform:1",    "uniform:2,1", "uniform:1,2,3",
                                      "uniform:1,2,size", "uniform:1,2,", "fuller:1,2",  "fuller:0,1,2",
                                      "single:0",         "single:1,2"};
    for (size_t k = 0; k < sizeof BAD / sizeof *BAD; k++) {
        err = (fl_err){0};
        assert_int_equal(fl_grading_law(&g, BAD[k], 3, &err), -1);
        assert_int_equal(err.code, FL_USAGE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(uniform_by_mass_has_its_number_curve),
        cmocka_unit_test(uniform_by_number_is_straight_in_number),
        cmocka_unit_test(fuller_is_a_power),
        cmocka_unit_test(volume_is_kept_where_a_sieve_is_empty),
        cmocka_unit_test(single_sizes_and_numbers_are_drawn),
        cmocka_unit_test(laws_that_are_none_are_told_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
