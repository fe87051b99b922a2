/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/rng.h"
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "shim/cgal_crossing.h"
#include "shim/cgal_repair.h"
#include "support/mesh.h"
#include "support/near.h"

static fl_err err;

static fl_part *part(fl_surface *s)
{
    const int32_t i = fl_surface_add(s, "p", 1, &err);
    assert_true(i >= 0);
    return &s->part[i];
}

static fl_soup soup_of(const fl_part *p)
{
    fl_soup s = {.nv = p->nv, .nt = p->nt};
    s.x = fl_alloc(3 * (int64_t)p->nv, sizeof *s.x, &err);
    s.t = fl_alloc(3 * (int64_t)p->nt, sizeof *s.t, &err);
    for (int32_t v = 0; v < p->nv; v++) memcpy(s.x + 3 * v, &p->v[v].x, 3 * sizeof *s.x);
    for (int32_t t = 0; t < p->nt; t++) memcpy(s.t + 3 * t, p->t[t].v, 3 * sizeof *s.t);
    return s;
}

/* Repairs p in place, and measures the result after joining coincident vertices. */
static fl_mesh_quality repaired(fl_part *p, int32_t holes, fl_repair *did)
{
    fl_soup s = soup_of(p);
    fl_weld w;
    fl_mesh_quality q;
    if (fl_cgal_repair(&s, holes, 0.0, did, &err)) fail_msg("%s", err.text);
    p->nv = p->nt = 0;
    for (int32_t v = 0; v < s.nv; v++)
        fl_surface_vertex(p, v3(s.x[3 * v], s.x[3 * v + 1], s.x[3 * v + 2]), &err);
    for (int32_t t = 0; t < s.nt; t++)
        fl_surface_triangle(p, s.t[3 * t], s.t[3 * t + 1], s.t[3 * t + 2], &err);
    fl_soup_free(&s);
    assert_int_equal(fl_part_weld(p, 0.0, &w, &err), 0);
    assert_int_equal(fl_part_measure(p, &q, &err), 0);
    return q;
}

static fl_crossing count_crossings(const fl_part *p)
{
    fl_soup s = soup_of(p);
    fl_crossing c;
    if (fl_cgal_crossings(&s, &c, &err)) fail_msg("%s", err.text);
    fl_soup_free(&s);
    return c;
}

static void reverse_triangle(fl_part *p, int32_t t)
{
    const int32_t keep = p->t[t].v[1];
    p->t[t].v[1] = p->t[t].v[2];
    p->t[t].v[2] = keep;
}

static void a_sound_box_stays_unchanged(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_tri before[12];
    fl_weld w;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 2, 3), &err);
    fl_part_weld(p, 0.0, &w, &err);
    memcpy(before, p->t, sizeof before);
    assert_near(repaired(p, 0, &did).volume, 6.0, 1e-15);
    assert_int_equal(did.bounding, 1);
    assert_int_equal(did.duplicates + did.stitched + did.degenerate + did.holes, 0);
    assert_memory_equal(before, p->t, sizeof before);
    fl_surface_free(&s);
}

static void doubled_and_reversed_triangles_are_repaired(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_mesh_quality q;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    for (int32_t t = 0; t < 12; t += 5) reverse_triangle(p, t);
    fl_surface_triangle(p, p->t[4].v[1], p->t[4].v[2], p->t[4].v[0], &err);
    fl_surface_triangle(p, p->t[7].v[0], p->t[7].v[2], p->t[7].v[1], &err);
    q = repaired(p, 0, &did);
    assert_int_equal(did.duplicates, 2);
    assert_int_equal(did.bounding, 1);
    assert_int_equal(q.triangles, 12);
    assert_near(q.volume, 1.0, 1e-15);
    fl_surface_free(&s);
}

static void holes_are_closed_on_request(void **state)
{
    (void)state;
    for (int32_t max_hole_edges = 0; max_hole_edges < 6; max_hole_edges++) {
        fl_surface s = {0};
        fl_part *p = part(&s);
        fl_repair did;
        fl_mesh_quality q;
        fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
        p->nt -= 2; /* the top: a boundary of four edges */
        q = repaired(p, max_hole_edges, &did);
        assert_int_equal(did.holes, max_hole_edges >= 4);
        assert_int_equal(did.patched, max_hole_edges >= 4 ? 2 : 0);
        assert_int_equal(did.bounding, max_hole_edges >= 4);
        assert_int_equal(q.open, max_hole_edges >= 4 ? 0 : 4);
        if (max_hole_edges >= 4) assert_near(q.volume, 1.0, 1e-15);
        fl_surface_free(&s);
    }
}

static void cavities_are_oriented_inward(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_mesh_quality q;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(4, 4, 4), &err);
    fl_facet_box(p, v3(1, 1, 1), v3(2, 2, 2), &err);
    fl_facet_box(p, v3(9, 0, 0), v3(10, 1, 1), &err);
    q = repaired(p, 0, &did);
    assert_int_equal(did.bounding, 1);
    assert_int_equal(q.inverted, 1);
    assert_int_equal(q.patches, 3);
    assert_near(q.volume, 64.0 - 1.0 + 1.0, 1e-15);
    fl_surface_free(&s);
}

/* A brace that ends inside a leg is no cavity: nothing is reversed where surfaces cross. */
static void crossing_bodies_are_counted(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_mesh_quality q;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_facet_box(p, v3(0.5, 0.25, 0.25), v3(2, 0.75, 0.75), &err);
    q = repaired(p, 0, &did);
    assert_true(count_crossings(p).crossings > 0);
    assert_int_equal(did.bounding, 0);
    assert_near(q.volume, 1.375, 1e-15);
    fl_surface_free(&s);
}

/* A box with one edge divided by a corner on one side only; the gap is filled by a triangle without area. */
static void collinear_triangles_are_removed(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_mesh_quality q;
    int32_t a = 0, b = 0, c = 0;
    const int32_t t = 11;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    for (int k = 0; k < 3; k++) /* side k of the last triangle that is an edge of the box */
        if (v3_norm(v3_sub(p->v[p->t[t].v[k]], p->v[p->t[t].v[(k + 1) % 3]])) < 1.2) {
            a = p->t[t].v[k];
            b = p->t[t].v[(k + 1) % 3];
            c = p->t[t].v[(k + 2) % 3];
            break;
        }
    fl_surface_vertex(p, v3_scale(0.5, v3_add(p->v[a], p->v[b])), &err);
    p->t[t] = (fl_tri){{a, p->nv - 1, c}};
    fl_surface_triangle(p, p->nv - 1, b, c, &err);
    fl_surface_triangle(p, a, b, p->nv - 1, &err);
    assert_int_equal(fl_part_measure(p, &q, &err), 0);
    assert_int_equal(q.open, 0);
    assert_int_equal(q.degenerate, 1);
    q = repaired(p, 0, &did);
    assert_int_equal(did.degenerate, 1);
    assert_int_equal(did.stuck, 0);
    assert_int_equal(q.open + q.branched + q.incoherent + q.degenerate, 0);
    assert_near(q.volume, 1.0, 1e-15);
    assert_near(q.area, 6.0, 1e-15);
    fl_surface_free(&s);
}

static void branched_edges_stay_unchanged(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_repair did;
    fl_weld w;
    fl_mesh_quality q;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_facet_box(p, v3(1, 1, 0), v3(2, 2, 1), &err);
    fl_part_weld(p, 0.0, &w, &err);
    q = repaired(p, 0, &did);
    assert_int_equal(count_crossings(p).crossings + count_crossings(p).touching, 0); /* they share an edge */
    assert_int_equal(q.branched, 1);
    assert_int_equal(q.open, 0);
    assert_int_equal(q.vertices, 14);
    assert_near(q.volume, 2.0, 1e-15);
    fl_surface_free(&s);
}

static void an_empty_soup_stays_empty(void **state)
{
    fl_surface s = {0};
    fl_soup none;
    fl_repair did;
    (void)state;
    none = soup_of(part(&s));
    assert_int_equal(fl_cgal_repair(&none, 3, 0.0, &did, &err), 0);
    assert_int_equal(none.nt, 0);
    assert_int_equal(did.bounding, 0);
    fl_soup_free(&none);
    fl_soup_free(&none);
    fl_surface_free(&s);
}

/* Triangles on any three of a few points, many of them collinear, coincident or doubled: no crash, a sound
 * result, and the same result on the second run. */
static void no_triangle_soup_crashes(void **state)
{
    (void)state;
    for (long k = 0; k < test_times(300); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_surface s = {0};
        fl_part *p = part(&s);
        const int32_t nv = 4 + (int32_t)fl_rng_in(&g, 0, 12), nt = 1 + (int32_t)fl_rng_in(&g, 0, 40);
        const double grid = k % 3 == 0 ? 1.0 : 1e-9;
        fl_soup one, two;
        fl_repair did, again;
        fl_err e = {0};
        int rc;
        for (int32_t v = 0; v < nv; v++) {
            const fl_vec3 x = v3(fl_rng_in(&g, 0, 3), fl_rng_in(&g, 0, 3), fl_rng_in(&g, 0, k % 2 ? 3 : 1));
            fl_surface_vertex(
                p, v3(floor(x.x / grid) * grid, floor(x.y / grid) * grid, floor(x.z / grid) * grid), &err);
        }
        while (p->nt < nt) {
            const int32_t a = (int32_t)fl_rng_in(&g, 0, nv), b = (int32_t)fl_rng_in(&g, 0, nv),
                          c = (int32_t)fl_rng_in(&g, 0, nv);
            if (a != b && b != c && c != a) fl_surface_triangle(p, a, b, c, &err);
        }
        one = soup_of(p);
        two = soup_of(p);
        rc = fl_cgal_repair(&one, k % 5 == 0 ? 10 : 0, 0.0, &did, &e);
        if (rc && e.code != FL_NUMERIC)
            print_error("seed %llu case %ld\n", (unsigned long long)test_seed(), k);
        assert_true(rc == 0 || e.code == FL_NUMERIC);
        assert_int_equal(rc, fl_cgal_repair(&two, k % 5 == 0 ? 10 : 0, 0.0, &again, &e));
        assert_int_equal(one.nv, two.nv);
        assert_int_equal(one.nt, two.nt);
        assert_memory_equal(&did, &again, sizeof did);
        if (one.nt) assert_memory_equal(one.t, two.t, 3 * (size_t)one.nt * sizeof *one.t);
        for (int32_t m = 0; m < 3 * one.nt; m++) assert_true(one.t[m] >= 0 && one.t[m] < one.nv);
        for (int32_t m = 0; m < 3 * one.nv; m++) assert_true(isfinite(one.x[m]));
        fl_soup_free(&one);
        fl_soup_free(&two);
        fl_surface_free(&s);
    }
}

static void a_failure_leaves_the_soup_unchanged(void **state)
{
    fl_surface s = {0};
    fl_part *p = part(&s);
    fl_soup soup;
    fl_repair did;
    fl_err e = {0};
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    soup = soup_of(p);
    fl_alloc_fail_after(0);
    assert_int_equal(fl_cgal_repair(&soup, 0, 0.0, &did, &e), -1);
    fl_alloc_fail_after(-1);
    assert_int_equal(e.code, FL_SYSTEM);
    assert_int_equal(soup.nt, 12);
    assert_memory_equal(soup.t, p->t, 12 * sizeof *p->t);
    fl_soup_free(&soup);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_sound_box_stays_unchanged),
                                       cmocka_unit_test(doubled_and_reversed_triangles_are_repaired),
                                       cmocka_unit_test(holes_are_closed_on_request),
                                       cmocka_unit_test(cavities_are_oriented_inward),
                                       cmocka_unit_test(crossing_bodies_are_counted),
                                       cmocka_unit_test(collinear_triangles_are_removed),
                                       cmocka_unit_test(branched_edges_stay_unchanged),
                                       cmocka_unit_test(an_empty_soup_stays_empty),
                                       cmocka_unit_test(no_triangle_soup_crashes),
                                       cmocka_unit_test(a_failure_leaves_the_soup_unchanged)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
