/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "mesh/vertex_fans.h"
#include "shim/cgal_crossing.h"
#include "support/near.h"

static fl_err err;
static fl_part p;
static uint8_t simple[FL_VERTEX_FAN_MAX + 2];

static int free_part(void **state)
{
    (void)state;
    fl_part_free(&p);
    return 0;
}

static void add_vertex(double x, double y, double z)
{
    if (fl_surface_vertex(&p, v3(x, y, z), &err)) fail_msg("%s", err.text);
}

static void add_triangle(int32_t a, int32_t b, int32_t c)
{
    if (fl_surface_triangle(&p, a, b, c, &err)) fail_msg("%s", err.text);
}

static void find_simple(void)
{
    if (fl_vertex_fans_simple(&p, simple, &err)) fail_msg("%s", err.text);
}

/* n corners on a circle about vertex 0, with `turns` revolutions. */
static void make_ring(int n, int revolutions, double low, double high)
{
    free_part(NULL);
    add_vertex(0, 0, 0);
    for (int k = 0; k < n; k++)
        add_vertex(cos(2 * PI * revolutions * k / n), sin(2 * PI * revolutions * k / n), k % 2 ? high : low);
    for (int k = 0; k < n; k++) add_triangle(0, 1 + k, 1 + (k + 1) % n);
}

static void closed_fans_are_simple(void **state)
{
    (void)state;
    for (int n = 3; n < 200; n += 1 + n / 20) {
        make_ring(n, 1, 0.0, 0.0);
        find_simple();
        assert_int_equal(simple[0], 1);
        for (int k = 1; k <= n; k++) assert_int_equal(simple[k], 1); /* two on the border, side by side */
        make_ring(n, 1, -0.1, n % 2 ? -0.1 : 0.2);
        find_simple();
        assert_int_equal(simple[0], 1);
    }
}

/* A vertex of very many triangles, in the order of the ring and against it. */
static void large_closed_fans_are_simple(void **state)
{
    (void)state;
    make_ring(FL_VERTEX_FAN_MAX, 1, -0.5, -0.5);
    find_simple();
    assert_int_equal(simple[0], 1);
    for (int k = 0; k < 500; k++) { /* some out of order */
        const fl_tri keep = p.t[7 * k];
        p.t[7 * k] = p.t[FL_VERTEX_FAN_MAX - 1 - 11 * k];
        p.t[FL_VERTEX_FAN_MAX - 1 - 11 * k] = keep;
    }
    find_simple();
    assert_int_equal(simple[0], 1);
    p.nt--; /* a gap */
    find_simple();
    assert_int_equal(simple[0], 1);
    p.t[p.nt - 2] = p.t[0]; /* one twice, one missing */
    find_simple();
    assert_int_equal(simple[0], 0);
    make_ring(FL_VERTEX_FAN_MAX + 1, 1, 0.0, 0.0);
    find_simple();
    assert_int_equal(simple[0], 0);
}

static void other_fans_are_not_simple(void **state)
{
    (void)state;
    for (int revolutions = 2; revolutions < 5;
         revolutions++) { /* each triangle is valid alone, and they cover one another */
        make_ring(7, revolutions, 0.0, 0.0);
        find_simple();
        assert_int_equal(simple[0], 0);
    }
    make_ring(6, 1, 0.0, 0.0);
    p.nt--;
    add_triangle(0, 1, 6); /* closed the wrong way */
    find_simple();
    assert_int_equal(simple[0], 0);
    p.nt--;
    add_triangle(0, 6, 1);
    add_triangle(0, 6, 1); /* twice */
    find_simple();
    assert_int_equal(simple[0], 0);
    make_ring(5, 1, 0.0, 0.0);
    add_triangle(0, 1, 0);
    find_simple();
    assert_int_equal(simple[0], 0);
    make_ring(6, 1, 0.0, 0.0);
    p.v[3] = v3(0.9, 0.1, 0.0); /* folded back */
    find_simple();
    assert_int_equal(simple[0], 0);
    make_ring(6, 1, 0.0, 0.0);
    p.v[2] = v3(2.0, 0.0, 0.0); /* without area */
    find_simple();
    assert_int_equal(simple[0], 0);
}

/* Sectors side by side from one border to another, in any order. */
static void open_fans_are_simple(void **state)
{
    (void)state;
    for (int n = 3; n < 150; n += 1 + n / 20)
        for (int gap = 1; gap < n; gap += 1 + gap / 4) {
            make_ring(n, 1, 0.0, 0.0);
            p.nt -= gap;
            for (int t = p.nt - 1; t > 0; t--) {
                const int u = 7 * t % (t + 1);
                const fl_tri swap = p.t[t];
                p.t[t] = p.t[u];
                p.t[u] = (fl_tri){{swap.v[2], swap.v[0], swap.v[1]}};
            }
            find_simple();
            assert_int_equal(simple[0], 1);
        }
}

/* Two corners in place of one: a chain that ends above its beginning, or behind it, covers it. */
static void fans_with_slits_are_not_simple(void **state)
{
    (void)state;
    for (int k = 0; k < 5; k++) {
        make_ring(8, 1, 0.0, 0.0);
        const double a = (k - 2) * 0.1;
        add_vertex(cos(a), sin(a), 0.0);
        p.t[7].v[2] = 9; /* instead of corner 1, and at its position for a = 0 */
        find_simple();
        assert_int_equal(simple[0], a < -0.05);
    }
    make_ring(6, 1, 0.0, 0.0); /* two chains */
    p.t[1] = p.t[--p.nt];
    p.t[3] = p.t[--p.nt];
    find_simple();
    assert_int_equal(simple[0], 0);
}

/* Rings of random corners, triangles in any order: where the fan is simple the search of CGAL finds no
 * crossing. */
static void simple_fans_do_not_cross(void **state)
{
    int is = 0, is_not = 0;
    (void)state;
    for (int k = 0; k < test_times(400); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const int n = 3 + (int)(fl_rng_u64(&g) % 6);
        const double far = k % 3 == 2 ? 1e6 : 0.0, wild = k % 2 ? 0.6 : 3.0, flat = k % 5 == 4 ? 1e-9 : 1.0;
        fl_crossing c;
        make_ring(n, 1, 0.0, 0.0);
        for (int v = 0; v <= n; v++) {
            p.v[v].x += wild * fl_rng_in(&g, -0.5, 0.5) + far;
            p.v[v].y += wild * fl_rng_in(&g, -0.5, 0.5);
            p.v[v].z = flat * wild * fl_rng_in(&g, -1.0, 1.0);
        }
        for (int t = n - 1; t > 0; t--) {
            const int u = (int)(fl_rng_u64(&g) % (uint64_t)(t + 1));
            const fl_tri swap = p.t[t];
            p.t[t] = p.t[u];
            p.t[u] = (fl_tri){{swap.v[1], swap.v[2], swap.v[0]}};
        }
        if (k % 4 == 3 && n > 4) p.nt -= 1 + k % 2; /* a chain, or two */
        find_simple();
        is += simple[0];
        is_not += !simple[0];
        if (!simple[0]) continue;
        const fl_soup s = {p.nv, p.nt, &p.v[0].x, p.t[0].v};
        if (fl_cgal_crossings(&s, &c, &err)) fail_msg("%s", err.text);
        assert_int_equal(c.crossings, 0);
        assert_int_equal(c.touching, 0);
    }
    assert_true(is > 50 && is_not > 50);
}

static void allocation_failure_is_reported(void **state)
{
    int rc = -1;
    (void)state;
    make_ring(6, 1, 0.0, 0.0);
    for (long fail = 0; rc; fail++) {
        err = (fl_err){0};
        fl_alloc_fail_after(fail);
        rc = fl_vertex_fans_simple(&p, simple, &err);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, rc ? FL_SYSTEM : 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(closed_fans_are_simple, free_part),
        cmocka_unit_test_teardown(large_closed_fans_are_simple, free_part),
        cmocka_unit_test_teardown(open_fans_are_simple, free_part),
        cmocka_unit_test_teardown(fans_with_slits_are_not_simple, free_part),
        cmocka_unit_test_teardown(other_fans_are_not_simple, free_part),
        cmocka_unit_test_teardown(simple_fans_do_not_cross, free_part),
        cmocka_unit_test_teardown(allocation_failure_is_reported, free_part),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
