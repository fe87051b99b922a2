/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/array.h"
#include "ice/faces.h"

static void make_floes(fl_floes *a, int32_t n, uint64_t seed, int smooth, double radius, fl_vec2 shift)
{
    const fl_vec2 lo = {-4.0, -3.0}, hi = {4.0, 3.0};
    fl_vec2 site[500];
    fl_power_cells c = {0};
    fl_err err = {0};
    assert_true(n <= 500);
    fl_random_sites(n, seed, lo, hi, site);
    assert_int_equal(fl_power_cells_build(&c, n, site, lo, hi, &err), 0);
    for (int k = 0; k < smooth; k++) {
        fl_power_cells_centroids(&c, site);
        fl_power_cells_free(&c);
        assert_int_equal(fl_power_cells_build(&c, n, site, lo, hi, &err), 0);
    }
    assert_int_equal(fl_floes_fill(a, &c, radius, shift, &err), 0);
    fl_power_cells_free(&c);
}

/* Every side lies on another one or on the outline. For the faces of n cells of a plane graph with e inner
 * edges, all sides = 2 e + outline sides, since each cell of a convex field keeps its sides. */
static void sides_form_pairs(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++) {
        const int32_t n = 5 + (int32_t)seed * 7;
        const fl_vec2 shift = {seed % 2 ? 1e4 : 0.0, 0.0};
        fl_floes a = {0};
        fl_faces f = {0};
        fl_err err = {0};
        double area = 0.0;
        make_floes(&a, n, seed, (int)(seed % 4), 0.0, shift);
        assert_int_equal(fl_faces_find(&f, &a, &err), 0);
        for (int32_t i = 0; i < n; i++)
            area += fl_polygon_area(a.first[i + 1] - a.first[i], a.outer + a.first[i]);
        assert_near(area, 48.0, 1e-7);
        /* corners and very short sides may be lost: they are shorter than 1e-3 of a floe's size */
        assert_near_of(f.perimeter - 2.0 * f.total_length, 28.0, 1e-3 / sqrt(n), f.perimeter);
        assert_true(f.max_overlap <= f.tolerance);
        for (int32_t k = 0; k < f.n; k++) {
            assert_true(f.face[k].i < f.face[k].j);
            if (k)
                assert_true(f.face[k].i > f.face[k - 1].i ||
                            (f.face[k].i == f.face[k - 1].i && f.face[k].j > f.face[k - 1].j));
        }
        fl_faces_free(&f);
        fl_floes_free(&a);
    }
}

/* With a dilation radius only short sides may be lost. */
static void rounding_drops_only_short_sides(void **state)
{
    (void)state;
    fl_floes a = {0};
    fl_faces f = {0};
    fl_err err = {0};
    double area = 0.0;
    make_floes(&a, 100, 3, 3, 0.05, (fl_vec2){0, 0});
    assert_int_equal(fl_faces_find(&f, &a, &err), 0);
    for (int32_t i = 0; i < a.n; i++)
        area += fl_polygon_area(a.first[i + 1] - a.first[i], a.outer + a.first[i]);
    assert_true(area <= 48.0 * (1.0 + 1e-14) && area > 0.999 * 48.0);
    assert_true(f.max_overlap <= f.tolerance);
    assert_true(f.perimeter - 2.0 * f.total_length >= 28.0 - 1e-9);
    assert_true(f.perimeter - 2.0 * f.total_length < 28.0 + 0.01 * f.perimeter);
    fl_faces_free(&f);
    fl_floes_free(&a);
}

/* Three rectangles: a long side on two shorter ones, and one that overlaps by a known depth. */
static void partial_sides_are_matched(void **state)
{
    (void)state;
    int32_t first[5] = {0, 4, 8, 12, 16};
    fl_vec2 outer[16] = {{0, 0}, {4, 0}, {4, 1}, {0, 1}, {0, 1}, {1.5, 1}, {1.5, 2}, {0, 2},
                         {2, 1}, {4, 1}, {4, 2}, {2, 2}, {8, 8}, {9, 8},   {9, 9},   {8, 9}};
    fl_floes a = {.n = 4, .first = first, .outer = outer};
    fl_faces f = {0};
    fl_err err = {0};
    assert_int_equal(fl_faces_find(&f, &a, &err), 0);
    assert_int_equal(f.n, 2);
    assert_int_equal(f.face[0].j, 1);
    assert_int_equal(f.face[1].j, 2);
    assert_near(f.total_length, 3.5, 1e-15);
    assert_near(f.face[0].a.x, 1.5, 1e-15); /* counter-clockwise around the long one */
    assert_true(f.face[0].b.x == 0.0 && f.face[0].b.y == 1.0);
    assert_true(f.max_overlap <= 0.0);
    fl_faces_free(&f);
    outer[12] = (fl_vec2){3.75, 0.5}; /* the fourth overlaps the first by a quarter */
    outer[13] = (fl_vec2){6, 0.5};
    outer[14] = (fl_vec2){6, 0.75};
    outer[15] = (fl_vec2){3.75, 0.75};
    assert_int_equal(fl_faces_find(&f, &a, &err), 0);
    assert_near(f.max_overlap, 0.25, 1e-14);
    assert_int_equal(f.max_overlap_pair[0], 0);
    assert_int_equal(f.max_overlap_pair[1], 3);
    fl_faces_free(&f);
}

static void allocation_failure_is_reported(void **state)
{
    (void)state;
    fl_floes a = {0};
    int rc = -1;
    make_floes(&a, 30, 1, 1, 0.0, (fl_vec2){0, 0});
    for (long k = 0; rc; k++) {
        fl_faces f = {0};
        fl_err err = {0};
        fl_alloc_fail_after(k);
        rc = fl_faces_find(&f, &a, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
        if (rc) assert_null(f.face);
        fl_faces_free(&f);
        assert_true(k < 100);
    }
    fl_floes_free(&a);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sides_form_pairs), cmocka_unit_test(rounding_drops_only_short_sides),
        cmocka_unit_test(partial_sides_are_matched), cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
