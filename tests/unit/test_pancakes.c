/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/certificate.h"
#include "ice/pancakes.h"

static const fl_vec2 LO = {-25.0, -20.0}, HI = {25.0, 20.0};

static void make_cells(fl_power_cells *c, int32_t n, uint64_t seed, int smooth)
{
    fl_vec2 site[500];
    fl_err err = {0};
    assert_true(n <= 500);
    fl_random_sites(n, seed, LO, HI, site);
    assert_int_equal(fl_power_cells_build(c, n, site, LO, HI, &err), 0);
    for (int k = 0; k < smooth; k++) {
        fl_power_cells_centroids(c, site);
        fl_power_cells_free(c);
        assert_int_equal(fl_power_cells_build(c, n, site, LO, HI, &err), 0);
    }
}

/* The requested area, S sides that turn left by less than 4 pi / S, and every outer corner inside its cell by
 * the floe's inset. */
static void floes_are_round_and_inside(void **state)
{
    (void)state;
    for (int k = 0; k < 24; k++) {
        const int32_t n = 1 + k * k / 2, sides = 6 + k;
        const double c = 0.3 + 0.02 * k, radius = 0.04 * (k % 3), turn = 4.0 * acos(-1.0) / sides;
        fl_power_cells cells = {0};
        fl_floes a = {0};
        fl_certificate cert;
        fl_err err = {0};
        make_cells(&cells, n, (uint64_t)k, 3);
        assert_int_equal(fl_pancakes_make(&a, &cells, sides, c, radius, (fl_vec2){0, 0}, &err), 0);
        assert_int_equal(fl_certificate_make(&cert, &a, &err), 0);
        assert_near(cert.total_area, c * 2000.0, 1e-12);
        assert_int_equal(cert.overlaps, 0);
        assert_true(cert.min_angle > acos(-1.0) - turn);
        for (int32_t i = 0; i < n; i++) {
            const double keep = a.limited ? 0.0 : a.inset;
            assert_int_equal(a.first[i + 1] - a.first[i], sides);
            for (int32_t v = a.first[i]; v < a.first[i + 1]; v++)
                for (int32_t e = cells.first[i]; e < cells.first[i + 1]; e++)
                    assert_true(fl_polygon_side_distance(cells.side[e], a.outer[v]) <= -keep + 1e-12 * 25.0);
        }
        if (sides >= 20) assert_true(fl_pancakes_circularity(&a) > 0.93);
        fl_floes_free(&a);
        fl_power_cells_free(&cells);
    }
}

/* A square cell of side s: K is a square, and the floe an S-gon on the square with round corners of radius r
 * = q s / 2. For many sides its area tends to that of the rounded square, s^2 - (4 - pi) r^2. */
static void many_sides_approach_the_rounded_square(void **state)
{
    (void)state;
    const fl_vec2 lo = {-1.0, -1.0}, hi = {1.0, 1.0};
    const double r = FL_PANCAKES_ROUNDNESS, max_area = 4.0 - (4.0 - acos(-1.0)) * r * r;
    const fl_vec2 site = {0.1, 0.2};
    fl_power_cells cells = {0};
    fl_floes a = {0};
    fl_err err = {0};
    assert_int_equal(fl_power_cells_build(&cells, 1, &site, lo, hi, &err), 0);
    assert_int_equal(fl_pancakes_make(&a, &cells, 120, 0.999 * max_area / 4.0, 0.0, (fl_vec2){0, 0}, &err),
                     0);
    assert_true(a.inset < 5e-4);
    fl_floes_free(&a);
    assert_int_equal(fl_pancakes_make(&a, &cells, 120, max_area / 4.0, 0.0, (fl_vec2){0, 0}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    err = (fl_err){0};
    assert_int_equal(fl_pancakes_make(&a, &cells, 12, 0.5, 1.5, (fl_vec2){0, 0}, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    fl_power_cells_free(&cells);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_power_cells cells = {0};
    int rc = -1;
    make_cells(&cells, 20, 1, 2);
    for (long k = 0; rc; k++) {
        fl_floes a = {0};
        fl_err err = {0};
        fl_alloc_fail_after(k);
        rc = fl_pancakes_make(&a, &cells, 12, 0.6, 0.05, (fl_vec2){0, 0}, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        if (rc) assert_null(a.first);
        fl_floes_free(&a);
        assert_true(k < 100);
    }
    fl_power_cells_free(&cells);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(floes_are_round_and_inside),
                                       cmocka_unit_test(many_sides_approach_the_rounded_square),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
