/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include "base/array.h"
#include "base/rng.h"
#include "mesh/crossing.h"
#include "support/near.h"

static const double TWO_PI = 6.283185307179586477;
static fl_err err;
static fl_part p;

static int free_part(void **state)
{
    (void)state;
    fl_part_free(&p);
    return 0;
}

/* The parallel search finds the pairs that the search of CGAL finds, one by one. */
static fl_crossing compare_with_cgal(void)
{
    const fl_soup s = {p.nv, p.nt, p.nv ? &p.v[0].x : NULL, p.nt ? p.t[0].v : NULL};
    fl_crossing expected, got;
    if (fl_cgal_crossings(&s, &expected, &err)) fail_msg("%s", err.text);
    for (int threads = 1; threads <= 3; threads++) {
        omp_set_num_threads(threads);
        if (fl_part_crossings(&p, &got, &err)) fail_msg("%s", err.text);
        assert_int_equal(got.crossings, expected.crossings);
        assert_int_equal(got.touching, expected.touching);
    }
    return got;
}

static void vertex(double x, double y, double z)
{
    if (fl_surface_vertex(&p, v3(x, y, z), &err)) fail_msg("%s", err.text);
}

static void triangle(int32_t a, int32_t b, int32_t c)
{
    if (fl_surface_triangle(&p, a, b, c, &err)) fail_msg("%s", err.text);
}

/* Corners on a small integer lattice, rotated or not, near the origin or far from it: pairs that share,
 * touch, are coplanar, cover each other, or have no area. */
static void the_search_finds_what_cgal_finds(void **state)
{
    int64_t crossings = 0, touching = 0;
    for (int k = 0; k < test_times(30); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const int side = 2 + (int)(fl_rng_u64(&g) % 6), turned = k % 3 == 1, nv = 20 + k % 40;
        const double far = k % 4 == 3 ? 1e6 : 0.0, size = k % 5 == 4 ? 1e-3 : 1.0;
        fl_crossing c;
        for (int v = 0; v < nv; v++) {
            const double x = (double)(fl_rng_u64(&g) % (uint64_t)side),
                         y = (double)(fl_rng_u64(&g) % (uint64_t)side);
            const double z = k % 2 ? (double)(fl_rng_u64(&g) % (uint64_t)side) : 0.0;
            if (turned) vertex(far + size * (0.6 * x - 0.8 * z), far + size * y, size * (0.8 * x + 0.6 * z));
            else vertex(far + size * x, far + size * y, size * z);
        }
        for (int t = 0; t < 60; t++) {
            const int32_t a = (int32_t)(fl_rng_u64(&g) % (uint64_t)nv), b = (a + 1 + t % (nv - 2)) % nv;
            const int32_t d = (int32_t)(fl_rng_u64(&g) % (uint64_t)nv);
            if (d != a && d != b) triangle(a, b, d);
        }
        c = compare_with_cgal();
        crossings += c.crossings;
        touching += c.touching;
        free_part(state);
    }
    assert_true(crossings > 500 && touching > 50);
}

/* A sheet of n by n squares of two triangles: flat, bent, rough. A second sheet crosses it at an angle. */
static void sheet(int n, double bend, double rough, double tilt)
{
    const int32_t first = p.nv;
    for (int i = 0; i <= n; i++)
        for (int j = 0; j <= n; j++) {
            fl_rng g = fl_rng_of(test_seed(), i * (n + 1) + j, FL_RNG_TEST);
            const double x = 0.7 * i, y = 0.3 * (j - 0.5 * n) + 0.05 * i,
                         z = bend * x * x + rough * fl_rng_in(&g, -1.0, 1.0);
            vertex(x, y * cos(tilt) - z * sin(tilt), y * sin(tilt) + z * cos(tilt));
        }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++) {
            const int32_t a = first + i * (n + 1) + j, b = a + n + 1;
            triangle(a, b, b + 1);
            triangle(a, b + 1, a + 1);
        }
}

static void sheets_cross_only_where_one_passes_through(void **state)
{
    static const double row[][3] = {{0, 0, 0}, {0, 0, 0.5}, {0.1, 0, 0}, {0, 0.05, 0.3}, {0.02, 0.2, 1.0}};
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        fl_crossing c;
        sheet(30, row[k][0], row[k][1], row[k][2]);
        c = compare_with_cgal();
        assert_int_equal(c.crossings, 0);
        assert_int_equal(c.touching, 0);
        sheet(20, 0.0, 0.01, row[k][2] + 0.7);
        c = compare_with_cgal();
        assert_true(c.crossings > 10);
        free_part(state);
    }
}

/* The side of a cone of n facets about an axis through o at an angle to the vertical, from a circle of radius
 * r up to one of radius q, or to a tip with q = 0. With bottom, n more facets close it below. */
static void cone(int n, fl_vec3 o, double tilt, double r, double q, double height, int bottom)
{
    const int32_t first = p.nv;
    for (int k = 0; k < 2 * n; k++) {
        const double a = TWO_PI * (k % n) / n, at = k < n ? r : q, z = k < n ? 0.0 : height;
        const double x = at * cos(a);
        vertex(o.x + x * cos(tilt) + z * sin(tilt), o.y + at * sin(a), o.z + z * cos(tilt) - x * sin(tilt));
    }
    vertex(o.x, o.y, o.z);
    for (int k = 0; k < n; k++) {
        const int32_t a = first + k, b = first + (k + 1) % n;
        if (q > 0.0) triangle(b, b + n, a + n);
        triangle(a, b, q > 0.0 ? a + n : first + n);
        if (bottom) triangle(b, a, first + 2 * n);
    }
}

/* Slivers whose boxes all overlap, which are tested in groups. Triangles that cross, lie on or touch them are
 * found all the same. */
static void cones_cross_only_where_something_passes_through(void **state)
{
    static const double tilt[] = {0.0, 0.3, 0.9553}; /* the last one: along a diagonal */
    for (size_t k = 0; k < sizeof tilt / sizeof *tilt; k++)
        for (int tip = 0; tip < 2; tip++) {
            const fl_vec3 o = v3(3.0 * (double)k, 2.0, 1.0);
            const double q = tip ? 0.0 : 0.4;
            fl_crossing c;
            cone(190, o, tilt[k], 2.0, q, 5.0, 1);
            c = compare_with_cgal();
            assert_int_equal(c.crossings + c.touching, 0);
            cone(40, v3(o.x + 0.5, o.y, o.z + 0.5), tilt[k] + 0.5, 0.7, 0.6, 6.0, 0);
            assert_true(compare_with_cgal().crossings > 100);
            free_part(state);
            cone(190, o, tilt[k], 2.0, q, 5.0, 1);
            cone(190, v3(o.x + 0.03, o.y + 0.02, o.z - 0.1), tilt[k], 2.0, q, 5.0,
                 0); /* next to itself, shifted by little */
            assert_true(compare_with_cgal().crossings > 100);
            free_part(state);
        }
}

/* Among 40 000 triangles; pair by pair, these would be more than 10^8 tests. */
static void large_cones_are_fast(void **state)
{
    fl_crossing c;
    cone(20000, v3(0, 0, 0), 0.0, 5.0, 0.0, 10.0, 1);
    cone(20000, v3(0, 0, -20.0), 0.0, 5.0, 1.0, 10.0, 0);
    if (fl_part_crossings(&p, &c, &err)) fail_msg("%s", err.text);
    assert_int_equal(c.crossings + c.touching, 0);
    free_part(state);
}

static void small_parts_and_allocation_failure(void **state)
{
    fl_crossing c;
    int rc = -1;
    assert_int_equal(fl_part_crossings(&p, &c, &err), 0);
    vertex(0, 0, 0);
    vertex(1, 0, 0);
    vertex(0, 1, 0);
    triangle(0, 1, 2);
    assert_int_equal(compare_with_cgal().crossings, 0);
    triangle(0, 2, 1); /* on the first */
    assert_int_equal(compare_with_cgal().crossings, 1);
    for (int k = 2; k < 40; k++) triangle(0, 1, 2);
    assert_int_equal(compare_with_cgal().crossings, 40 * 39 / 2);
    for (long fail = 0; rc; fail++) {
        err = (fl_err){0};
        fl_alloc_fail_after(fail);
        rc = fl_part_crossings(&p, &c, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
    }
    free_part(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(the_search_finds_what_cgal_finds, free_part),
        cmocka_unit_test_teardown(sheets_cross_only_where_one_passes_through, free_part),
        cmocka_unit_test_teardown(cones_cross_only_where_something_passes_through, free_part),
        cmocka_unit_test_teardown(large_cones_are_fast, free_part),
        cmocka_unit_test_teardown(small_parts_and_allocation_failure, free_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
