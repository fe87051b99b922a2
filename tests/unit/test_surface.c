/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/facet.h"
#include "geom/mesh_patch.h"
#include "geom/surface.h"
#include "geom/weld.h"
#include "support/near.h"

static fl_err err;

static fl_part *add_part(fl_surface *s)
{
    const int32_t i = fl_surface_add(s, "p", 1, &err);
    assert_true(i >= 0);
    return &s->part[i];
}

static fl_mesh_quality measure_part(const fl_part *p)
{
    fl_mesh_quality q;
    assert_int_equal(fl_part_measure(p, &q, &err), 0);
    return q;
}

static void assert_point(fl_vec3 x, fl_vec3 expected, double tol, double scale)
{
    assert_near_of(x.x, expected.x, tol, scale);
    assert_near_of(x.y, expected.y, tol, scale);
    assert_near_of(x.z, expected.z, tol, scale);
}

static void reverse_triangle(fl_part *p, int32_t t)
{
    const int32_t keep = p->t[t].v[1];
    p->t[t].v[1] = p->t[t].v[2];
    p->t[t].v[2] = keep;
}

static void names_are_one_word_and_unique(void **state)
{
    fl_surface s = {0};
    (void)state;
    fl_surface_add(&s, "leg one", 7, &err);
    fl_surface_add(&s, "leg one", 7, &err);
    fl_surface_add(&s, "#\t\x01", 3, &err);
    fl_surface_add(&s, "", 0, &err);
    fl_surface_add(&s, "", 0, &err);
    fl_surface_add(&s, "leg_one", 7, &err);
    assert_string_equal(s.part[0].name, "leg_one");
    assert_string_equal(s.part[1].name, "leg_one_2");
    assert_string_equal(s.part[2].name, "___");
    assert_string_equal(s.part[3].name, "part");
    assert_string_equal(s.part[4].name, "part_2");
    assert_string_equal(s.part[5].name, "leg_one_3");
    assert_int_equal(s.part[5].id, 5);
    assert_int_equal(fl_surface_find(&s, "leg one_2", 9), 1);
    assert_int_equal(fl_surface_find(&s, "leg", 3), -1);
    fl_surface_free(&s);
    fl_surface_free(&s);
}

static void box_is_exact_far_from_the_origin(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double far = k ? pow(2.0, 10.0 * k) : 0.0; /* exact sums */
        fl_surface s = {0};
        fl_part *p = add_part(&s);
        fl_mesh_quality q;
        fl_facet_box(p, v3(far, -far, 3 * far), v3(far + 1, -far + 2, 3 * far + 3), &err);
        q = measure_part(p);
        assert_near(q.volume, 6.0, 1e-15);
        assert_near(q.area, 22.0, 1e-15);
        assert_point(q.centroid, v3(far + 0.5, -far + 1, 3 * far + 1.5), 1e-15, 4 * far + 1);
        assert_int_equal(q.closed, 1);
        assert_int_equal(q.open + q.branched + q.incoherent + q.inverted + q.degenerate, 0);
        assert_int_equal(q.patches, 1);
        assert_near(q.shortest_edge, 1.0, 0);
        assert_near(q.box.hi.y, -far + 2, 0);
        fl_surface_free(&s);
    }
}

static void tetrahedron_is_exact(void **state)
{
    static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    static const int32_t t[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_mesh_quality q;
    (void)state;
    for (int k = 0; k < 4; k++) fl_surface_vertex(p, v3(x[k][0], x[k][1], x[k][2]), &err);
    for (int k = 0; k < 4; k++) fl_surface_triangle(p, t[k][0], t[k][1], t[k][2], &err);
    q = measure_part(p);
    assert_near(q.volume, 1.0 / 6.0, 1e-14);
    assert_near(q.area, 1.5 + sqrt(3.0) / 2.0, 1e-14);
    assert_point(q.centroid, v3(0.25, 0.25, 0.25), 1e-14, 1.0);
    fl_surface_free(&s);
}

/* N facets of a frustum: V = (N / 2) sin(2 pi / N) h (R^2 + R r + r^2) / 3, for any direction of the axis. */
static void facets_have_the_volume_of_their_prism(void **state)
{
    static const int32_t corners[] = {3, 4, 5, 8, 17, 64, 1001};
    (void)state;
    for (int k = 0; k < 7; k++) {
        for (int tip = 0; tip < 3; tip++) {
            const double n = corners[k], r0 = tip == 1 ? 0.0 : 2.0, r1 = tip == 2 ? 0.0 : 0.5;
            const fl_vec3 axis = tip ? v3(3, -4, 12) : v3(0, 0, 13);
            const fl_cone c = {v3(10, 20, -5), v3_add(v3(10, 20, -5), axis), r0, r1};
            const double squares = r0 * r0 + r0 * r1 + r1 * r1;
            const double along = 0.25 * (r0 * r0 + 2 * r0 * r1 + 3 * r1 * r1) / squares;
            fl_surface s = {0};
            fl_part *p = add_part(&s);
            fl_mesh_quality q;
            assert_int_equal(fl_facet_cone(p, &c, corners[k], &err), 0);
            q = measure_part(p);
            assert_near(q.volume, 0.5 * n * sin(2 * PI / n) * 13.0 * squares / 3.0, 1e-12);
            assert_point(q.centroid, v3_madd(c.p0, along, axis), 1e-12, 20.0);
            assert_int_equal(q.open + q.branched + q.incoherent + q.degenerate, 0);
            assert_int_equal(q.patches, 1);
            fl_surface_free(&s);
        }
    }
}

/* A cone in closed form equals the limit of its facets. */
static void cones_are_the_limit_of_their_facets(void **state)
{
    const fl_cone c = {v3(1, 2, 3), v3(2, 4, 5), 0.75, 0.25};
    fl_surface s = {0};
    fl_mesh_quality round, flat, both;
    (void)state;
    fl_surface_cone(add_part(&s), c, &err);
    fl_facet_cone(add_part(&s), &c, 2000, &err);
    round = measure_part(&s.part[0]);
    flat = measure_part(&s.part[1]);
    assert_int_equal(round.closed, 1);
    assert_near(round.volume, flat.volume, 1e-5);
    assert_near(round.area, flat.area, 1e-5);
    assert_point(round.centroid, flat.centroid, 1e-6, 1.0);
    assert_point(round.box.lo, flat.box.lo, 1e-5, 1.0);
    assert_point(round.box.hi, flat.box.hi, 1e-5, 1.0);
    assert_int_equal(fl_surface_measure(&s, &both, &err), 0);
    assert_near(both.volume, round.volume + flat.volume, 1e-12);
    assert_near(both.area, round.area + flat.area, 1e-12);
    assert_point(both.centroid, round.centroid, 1e-6, 1.0);
    fl_surface_free(&s);
}

/* Area, number and winding of the triangles of one polygon. */
static void check_polygon(int32_t n, const double (*xy)[2], double area, int32_t triangles)
{
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    int32_t loop[16];
    fl_mesh_quality q;
    for (int32_t k = 0; k < n; k++) {
        fl_surface_vertex(p, v3(xy[k][0] + 100, xy[k][1], 0.3 * xy[k][0]), &err);
        loop[k] = k;
    }
    assert_int_equal(fl_facet_polygon(p, n, loop, &err), 0);
    q = measure_part(p);
    assert_int_equal(q.triangles, triangles);
    assert_int_equal(q.incoherent, 0);
    assert_int_equal(q.open, n);
    assert_int_equal(q.degenerate, 0);
    assert_near(q.area, area * sqrt(1.09), 1e-13); /* the plane z = 0.3 x */
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        assert_true(v3_cross(v3_sub(p->v[v[1]], p->v[v[0]]), v3_sub(p->v[v[2]], p->v[v[0]])).z > 0.0);
    }
    fl_surface_free(&s);
}

static void polygons_become_triangles(void **state)
{
    static const double ell[][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double arrow[][2] = {{0, 0}, {2, -2}, {1, 0}, {2, 2}};
    static const double comb[][2] = {{0, 0}, {7, 0}, {7, 3}, {6, 3}, {6, 1}, {4, 1},
                                     {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
    static const double with_straight_corner[][2] = {
        {0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}; /* a corner on a straight side */
    static const double hole[][2] = {
        {0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0}, /* out, and back in to the hole */
        {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};
    (void)state;
    check_polygon(10, hole, 12.0, 8);
    check_polygon(6, ell, 6.0, 4);
    check_polygon(4, arrow, 2.0, 2);
    check_polygon(12, comb, 13.0, 10);
    check_polygon(5, with_straight_corner, 4.0, 3);
}

static void expect_split(const double (*x)[3], const int32_t first[3])
{
    static const int32_t loop[4] = {0, 1, 2, 3};
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    for (int k = 0; k < 4; k++) fl_surface_vertex(p, v3(x[k][0], x[k][1], x[k][2]), &err);
    assert_int_equal(fl_facet_polygon(p, 4, loop, &err), 0);
    assert_int_equal(p->nt, 2);
    assert_memory_equal(p->t[0].v, first, sizeof p->t[0].v);
    fl_surface_free(&s);
}

static void quadrilaterals_take_the_better_diagonal(void **state)
{
    static const double square[][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const double kite[][3] = {{0, 0, 0}, {2, -1, 0}, {9, 0, 0}, {2, 1, 0}};
    static const double warped[][3] = {{0, 0, 0}, {4, 0, 0}, {4.5, 2.2, 0}, {0, 2, 1.5}};
    static const int32_t even[] = {0, 1, 2}, odd[] = {1, 2, 3};
    (void)state;
    expect_split(square, even); /* a tie: through the lowest index */
    expect_split(kite, odd);    /* flat: the shorter diagonal */
    expect_split(warped, odd);  /* warped: angles decide, 25.7 deg against 24.6 deg */
}

static void polygons_skip_repeated_corners(void **state)
{
    static const int32_t flat[] = {0, 0, 1, 1, 1}, good[] = {0, 1, 1, 2, 0};
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    (void)state;
    for (int k = 0; k < 3; k++) fl_surface_vertex(p, v3(k == 1, k == 2, 0), &err);
    assert_int_equal(fl_facet_polygon(p, 5, flat, &err), 0);
    assert_int_equal(p->nt, 0);
    assert_int_equal(fl_facet_polygon(p, 5, good, &err), 0);
    assert_int_equal(p->nt, 1);
    fl_surface_free(&s);
}

/* H40: inverted, and with any half of the triangles reversed. */
static void wrong_orientation_is_repaired(void **state)
{
    (void)state;
    for (int mask = 0; mask < 4096; mask += 7) {
        fl_surface s = {0};
        fl_part *p = add_part(&s);
        fl_mesh_quality came;
        fl_orient_counts o;
        fl_mesh_quality q;
        int turned = 0;
        fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
        for (int t = 0; t < 12; t++)
            if (mask >> t & 1) {
                reverse_triangle(p, t);
                turned++;
            }
        q = measure_part(p);
        assert_int_equal(q.incoherent > 0, turned % 12 > 0);
        assert_int_equal(q.inverted, turned == 12);
        assert_int_equal(fl_part_orient(p, &came, &o, &err), 0);
        assert_memory_equal(&came, &q, sizeof q); /* measured before it was reversed */
        assert_int_equal(o.triangles, turned < 12 - turned ? turned : 12 - turned);
        assert_int_equal(o.kept_side + o.one_sided, 0);
        if (turned != 6) assert_int_equal(o.patches, turned > 6);
        q = measure_part(p);
        assert_near(q.volume, 1.0, 1e-15);
        assert_int_equal(q.incoherent + q.inverted, 0);
        fl_surface_free(&s);
    }
}

static void open_patches_keep_the_side_of_larger_area(void **state)
{
    static const double x[6][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {9, 0, 0}, {9, 1, 0}};
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_mesh_quality came;
    fl_orient_counts o;
    fl_mesh_quality q;
    (void)state;
    for (int k = 0; k < 6; k++) fl_surface_vertex(p, v3(x[k][0], x[k][1], x[k][2]), &err);
    fl_surface_triangle(p, 0, 1, 2, &err); /* up, small */
    fl_surface_triangle(p, 0, 2, 3, &err); /* up, small */
    fl_surface_triangle(p, 1, 2, 4, &err); /* down, large */
    fl_surface_triangle(p, 4, 2, 5, &err); /* down, large */
    assert_int_equal(fl_part_orient(p, &came, &o, &err), 0);
    assert_int_equal(o.triangles, 2);
    assert_int_equal(o.kept_side, 1);
    assert_int_equal(o.patches, 0);
    assert_int_equal(p->t[2].v[1], 2);
    q = measure_part(p);
    assert_int_equal(q.incoherent, 0);
    assert_int_equal(q.open, 6);
    assert_int_equal(q.closed, 0);
    assert_near(q.area, 9.0, 1e-15);
    assert_point(q.centroid, v3(4.5, 0.5, 0), 1e-14, 1.0); /* of the area */
    fl_surface_free(&s);
}

static void a_twisted_band_is_named(void **state)
{
    enum { N = 9 };
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_mesh_quality came;
    fl_orient_counts o;
    fl_mesh_quality q;
    (void)state;
    for (int k = 0; k < N; k++) {
        const double a = 2 * PI * k / N, b = a / 2;
        for (int side = -1; side <= 1; side += 2) {
            const double r = 3 + side * cos(b);
            fl_surface_vertex(p, v3(r * cos(a), r * sin(a), side * sin(b)), &err);
        }
    }
    for (int32_t k = 0; k < N; k++) {
        const int32_t a = 2 * k, b = a + 1, c = k + 1 < N ? a + 2 : 1, d = k + 1 < N ? a + 3 : 0;
        fl_surface_triangle(p, a, b, d, &err);
        fl_surface_triangle(p, a, d, c, &err);
    }
    assert_int_equal(fl_part_orient(p, &came, &o, &err), 0);
    assert_int_equal(o.one_sided, 1);
    q = measure_part(p);
    assert_int_equal(q.patches, 1);
    assert_int_equal(q.incoherent > 0, 1);
    fl_surface_free(&s);
}

/* Two boxes that share an edge: four triangles there, two patches, and the right volume. */
static void a_shared_edge_is_branched(void **state)
{
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_weld w;
    fl_mesh_quality q;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_facet_box(p, v3(1, 1, 0), v3(2, 2, 1), &err);
    assert_int_equal(fl_part_weld(p, 0.0, &w, &err), 0);
    assert_int_equal(w.merged, 2);
    q = measure_part(p);
    assert_int_equal(q.branched, 1);
    assert_int_equal(q.patches, 2);
    assert_int_equal(q.open, 0);
    assert_int_equal(q.closed, 1);
    assert_near(q.volume, 2.0, 1e-15);
    fl_surface_free(&s);
}

/* Every triangle with its own vertices, each off by up to e. */
static void separate_triangles(fl_part *to, const fl_part *from, double e)
{
    for (int32_t t = 0; t < from->nt; t++) {
        for (int k = 0; k < 3; k++) {
            fl_rng g = fl_rng_of(test_seed(), 3 * t + k, FL_RNG_TEST);
            const fl_vec3 d = v3(fl_rng_in(&g, -e, e), fl_rng_in(&g, -e, e), fl_rng_in(&g, -e, e));
            fl_surface_vertex(to, v3_add(from->v[from->t[t].v[k]], d), &err);
        }
        fl_surface_triangle(to, 3 * t, 3 * t + 1, 3 * t + 2, &err);
    }
}

static void welding_closes_a_triangle_soup(void **state)
{
    const fl_cone c = {v3(50, 60, -5), v3(50, 60, 5), 2, 2};
    (void)state;
    for (int k = 0; k < 3; k++) {
        const double e = k == 0 ? 0.0 : k == 1 ? 1e-6 : 1e-3;
        fl_surface s = {0};
        fl_part *whole, *soup;
        fl_weld w;
        fl_mesh_quality q;
        add_part(&s);
        add_part(&s);
        whole = &s.part[0];
        soup = &s.part[1];
        fl_facet_cone(whole, &c, 48, &err);
        separate_triangles(soup, whole, e);
        assert_int_equal(fl_part_weld(soup, k == 2 ? 5e-3 : -1.0, &w, &err), 0);
        assert_int_equal(soup->nv, whole->nv);
        assert_int_equal(w.merged, 3 * whole->nt - whole->nv);
        assert_int_equal(w.collapsed, 0);
        assert_true(w.moved <= 2 * sqrt(3.0) * e && (e == 0.0 || w.moved > 0.1 * e));
        q = measure_part(soup);
        assert_int_equal(q.open + q.branched + q.incoherent, 0);
        assert_near_of(q.volume, measure_part(whole).volume, e == 0.0 ? 1e-13 : 10 * e,
                       measure_part(whole).volume);
        fl_surface_free(&s);
    }
}

/* Numbers follow the order of first use, so a permuted vertex list gives the same result. */
static void welding_numbers_by_first_use(void **state)
{
    fl_surface s = {0};
    fl_part *p, *q;
    fl_weld w;
    (void)state;
    add_part(&s);
    add_part(&s);
    p = &s.part[0];
    q = &s.part[1];
    fl_facet_box(p, v3(-1, -2, -3), v3(1, 2, 3), &err);
    fl_surface_vertex(q, v3(7, 7, 7), &err); /* used by no triangle */
    for (int32_t v = p->nv; v-- > 0;) fl_surface_vertex(q, p->v[v], &err);
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        fl_surface_triangle(q, p->nv - v[0], p->nv - v[1], p->nv - v[2], &err);
    }
    assert_int_equal(fl_part_weld(p, -1.0, &w, &err), 0);
    assert_int_equal(fl_part_weld(q, -1.0, &w, &err), 0);
    assert_int_equal(w.unused, 1);
    assert_int_equal(p->nv, q->nv);
    assert_memory_equal(p->t, q->t, (size_t)p->nt * sizeof *p->t);
    assert_memory_equal(p->v, q->v, (size_t)p->nv * sizeof *p->v);
    fl_surface_free(&s);
}

static void welding_refuses_destructive_tolerances(void **state)
{
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_weld w;
    fl_err e = {0};
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 0.25), &err);
    assert_int_equal(fl_part_weld(p, 0.3, &w, &e), -1);
    assert_int_equal(e.code, FL_INPUT);
    assert_string_equal(e.text,
                        "part \"p\": the welding tolerance 0.3 m is above the shortest edge, 0.25 m: less "
                        "is expected");
    assert_int_equal(p->nt, 12);
    p->v[0].x = 1e200;
    e = (fl_err){0};
    assert_int_equal(fl_part_weld(p, -1.0, &w, &e), -1);
    assert_int_equal(e.code, FL_INPUT);
    fl_surface_free(&s);
}

/* The default tolerance stays below the shortest edge: a mesh with one short edge is kept. */
static void the_default_tolerance_keeps_short_edges(void **state)
{
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_weld w;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1000, 1, 1e-5), &err);
    assert_int_equal(fl_part_weld(p, -1.0, &w, &err), 0);
    assert_near(w.tol, 0.5e-5, 1e-12);
    assert_int_equal(w.merged + w.collapsed, 0);
    fl_surface_free(&s);
}

static void degenerate_triangles_are_dropped(void **state)
{
    fl_surface s = {0};
    fl_part *p = add_part(&s);
    fl_weld w;
    (void)state;
    fl_facet_box(p, v3(0, 0, 0), v3(1, 1, 1), &err);
    fl_surface_vertex(p, v3(0, 0, -0.0), &err);
    fl_surface_triangle(p, 0, 1, 8, &err);
    fl_surface_triangle(p, 0, 0, 1, &err);
    assert_int_equal(measure_part(p).degenerate, 2);
    assert_int_equal(fl_part_weld(p, 0.0, &w, &err), 0);
    assert_int_equal(w.collapsed, 2);
    assert_int_equal(w.merged, 1);
    assert_int_equal(measure_part(p).degenerate, 0);
    assert_int_equal(measure_part(p).open, 0);
    fl_surface_free(&s);
}

static void allocation_failure_is_reported(void **state)
{
    const fl_cone c = {v3(0, 0, 0), v3(0, 0, 1), 1, 0.5};
    (void)state;
    for (long k = 0;; k++) {
        fl_surface s = {0};
        fl_err e = {0};
        fl_weld w;
        fl_orient_counts o;
        fl_mesh_quality q;
        int32_t i;
        int rc;
        fl_alloc_fail_after(k);
        i = fl_surface_add(&s, "p", 1, &e);
        rc = i < 0 || fl_facet_cone(&s.part[i], &c, 12, &e) || fl_part_weld(&s.part[i], -1.0, &w, &e) ||
             fl_part_orient(&s.part[i], &q, &o, &e) || fl_surface_measure(&s, &q, &e);
        fl_alloc_fail_after(-1);
        fl_surface_free(&s);
        assert_int_equal(rc, e.code != 0);
        if (!rc) break;
        assert_int_equal(e.code, FL_SYSTEM);
        assert_true(k < 100);
    }
}

/* Thousands of parts of one name, and of different names. A removed name belongs to no part; a part that
 * moved into another index is found there. */
static void thousands_of_names_stay_distinct(void **state)
{
    enum { N = 3000 };
    fl_surface s = {0};
    char name[40];
    (void)state;
    for (int k = 0; k < N; k++) {
        assert_int_equal(fl_surface_add(&s, "bolt", 4, &err), 2 * k);
        snprintf(name, sizeof name, "nut %d", k);
        assert_int_equal(fl_surface_add(&s, name, strlen(name), &err), 2 * k + 1);
    }
    assert_string_equal(s.part[2].name, "bolt_2");
    assert_string_equal(s.part[2 * N - 2].name, "bolt_3000");
    assert_int_equal(s.part[2 * N - 1].id, 2 * N - 1);
    assert_int_equal(fl_surface_find(&s, "nut_2999", 8), 2 * N - 1);
    assert_int_equal(fl_surface_find(&s, "nut_3000", 8), -1);
    fl_part_free(&s.part[5]); /* the last one moves to its index */
    s.part[5] = s.part[--s.n];
    assert_int_equal(fl_surface_find(&s, "nut 2999", 8), 5);
    assert_int_equal(fl_surface_find(&s, "nut 2", 5), -1);
    assert_int_equal(fl_surface_add(&s, "nut 2", 5, &err), 2 * N - 1);
    assert_string_equal(s.part[s.n - 1].name, "nut_2");
    assert_int_equal(s.part[s.n - 1].id, 2 * N);
    assert_int_equal(fl_surface_find(&s, "nut 2", 5), s.n - 1);
    fl_surface_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thousands_of_names_stay_distinct),
                                       cmocka_unit_test(names_are_one_word_and_unique),
                                       cmocka_unit_test(box_is_exact_far_from_the_origin),
                                       cmocka_unit_test(tetrahedron_is_exact),
                                       cmocka_unit_test(facets_have_the_volume_of_their_prism),
                                       cmocka_unit_test(cones_are_the_limit_of_their_facets),
                                       cmocka_unit_test(polygons_become_triangles),
                                       cmocka_unit_test(quadrilaterals_take_the_better_diagonal),
                                       cmocka_unit_test(polygons_skip_repeated_corners),
                                       cmocka_unit_test(wrong_orientation_is_repaired),
                                       cmocka_unit_test(open_patches_keep_the_side_of_larger_area),
                                       cmocka_unit_test(a_twisted_band_is_named),
                                       cmocka_unit_test(a_shared_edge_is_branched),
                                       cmocka_unit_test(welding_closes_a_triangle_soup),
                                       cmocka_unit_test(welding_numbers_by_first_use),
                                       cmocka_unit_test(welding_refuses_destructive_tolerances),
                                       cmocka_unit_test(the_default_tolerance_keeps_short_edges),
                                       cmocka_unit_test(degenerate_triangles_are_dropped),
                                       cmocka_unit_test(allocation_failure_is_reported)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
