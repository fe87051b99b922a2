/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "base/pi.h"
#include "base/rng.h"
#include "geom/clip.h"
#include "support/near.h"
#include "support/shapes.h"
#include "water/buoyancy.h"
#include "water/current.h"
#include "water/drag.h"
#include "water/facet_drag.h"

static void make_floe(fl_poly *p, fl_hull *h, double x, double y, double z)
{
    fl_err err = {0};
    assert_int_equal(fl_poly_box(p, v3(x / 2, y / 2, z / 2), &err), 0);
    assert_int_equal(fl_hull_make(h, p, 0.0, &err), 0);
}

static void upright_box(void **state)
{
    (void)state;
    fl_poly p;
    fl_hull h;
    fl_submerged w;
    fl_waterplane a;
    fl_vec3 f, m;
    make_floe(&p, &h, 10, 6, 1);
    assert_near(h.volume, 60.0, 1e-15);
    assert_near(h.surface_area, 152.0, 1e-15);
    fl_hull_submerged(&h, v3(0, 0, 1), 0.3, &w);
    assert_near(w.volume, 48.0, 1e-15);
    assert_near(w.centre.z, -0.1, 1e-15);
    assert_near_of(w.centre.x, 0.0, 1e-15, 10.0);
    assert_near(w.waterplane_area, 60.0, 1e-15);
    assert_near(w.wetted_area, 60.0 + 0.8 * 32, 1e-15);
    const double u = fl_buoyancy_force(&w, v3(0, 0, 1), 0.3, 1e4, &f, &m);
    assert_near(f.z, 48e4, 1e-15);
    assert_near_of(v3_norm(m), 0.0, 1e-15, 48e5);
    assert_near(u, 1e4 * 48.0 * 0.4, 1e-15);
    fl_hull_waterplane(&h, v3(0, 0, 1), 0.3, &a);
    assert_near(a.area, 60.0, 1e-15);
    assert_near(a.second.m[0][0], 6 * 1000.0 / 12, 1e-14);
    assert_near(a.second.m[1][1], 10 * 216.0 / 12, 1e-14);
    assert_near(a.centre.z, 0.3, 1e-15);
    fl_hull_free(&h);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* Freeboard zero, keel dry, and the limits beyond: nothing is missing or counted twice (H23). */
static void plane_through_faces(void **state)
{
    (void)state;
    fl_poly p;
    fl_hull h;
    fl_submerged w;
    make_floe(&p, &h, 10, 10, 1);
    for (int k = -20; k <= 20; k++) {
        const double off = k * 1e-10;
        fl_hull_submerged(&h, v3(0, 0, 1), 0.5 + off, &w);
        assert_near_of(w.volume, off < 0 ? 100 + 100 * off : 100.0, 1e-14, 100.0);
        assert_near_of(w.centre.z, off < 0 ? off / 2 : 0.0, 1e-13, 1.0);
        assert_near(w.waterplane_area, off < 0 ? 100.0 : 0.0, 1e-14);
        fl_hull_submerged(&h, v3(0, 0, 1), -0.5 + off, &w);
        assert_near_of(w.volume, off > 0 ? 100 * off : 0.0, 1e-14, 100.0);
        assert_near(w.waterplane_area, off > 0 ? 100.0 : 0.0, 1e-14);
    }
    fl_hull_submerged(&h, v3(0, 0, 1), 1e9, &w);
    assert_near(w.volume, 100.0, 1e-15);
    assert_near(w.wetted_area, 240.0, 1e-15);
    fl_hull_submerged(&h, v3(0, 0, 1), -1e9, &w);
    assert_near(w.volume, 0.0, 0.0);
    assert_near(w.wetted_area, 0.0, 0.0);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* A right prism over n points of an ellipse, rotated and moved off the origin. */
static void random_prism(fl_poly *p, fl_rng *g, int32_t n)
{
    fl_vec3 xy[16];
    fl_err err = {0};
    double at = 0.0;
    for (int32_t k = 0; k < n; k++) {
        at += 2.0 * PI / n * fl_rng_in(g, 0.6, 1.0);
        xy[k] = v3(3.0 * cos(at), 2.0 * sin(at), 0);
    }
    const fl_quat q = q_of_vector(v3(fl_rng_in(g, -2, 2), fl_rng_in(g, -2, 2), fl_rng_in(g, -2, 2)));
    assert_int_equal(fl_poly_prism(p, n, xy, -0.3, 0.2, &err), 0);
    fl_poly_to_frame(p, v3(fl_rng_in(g, -1, 1), fl_rng_in(g, -1, 1), fl_rng_in(g, -1, 1)), q_matrix(q));
}

/* The closed formulae equal those of the clipped solid: upright, tilted and turned over. Where the water
 * reaches a cap the general formula takes over, continuously. */
static void prism_buoyancy_has_closed_formulae(void **state)
{
    (void)state;
    int32_t used = 0, left = 0;
    for (int t = 0; t < test_times(4000); t++) {
        fl_rng g = fl_rng_of(test_seed(), t, FL_RNG_TEST);
        fl_poly p;
        fl_hull h;
        fl_submerged w, clipped;
        fl_err err = {0};
        random_prism(&p, &g, 3 + t % 14);
        assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
        assert_near(h.prism.area * (h.prism.z1 - h.prism.z0), h.volume, 1e-13);
        const fl_prism as = h.prism;
        const double tilt = 0.3 * fl_rng_in(&g, 0, 1) * fl_rng_in(&g, 0, 1), to = fl_rng_in(&g, 0, 2.0 * PI);
        const fl_vec3 e = v3_scale(t % 2 ? -1.0 : 1.0, as.e);
        const fl_vec3 up =
            v3_unit(v3_madd(v3_madd(e, tilt * cos(to), as.a), tilt * sin(to), v3_cross(as.e, as.a)));
        const double middle = v3_dot(up, v3_madd(as.o, 0.5 * (as.z0 + as.z1), as.e));
        const double level = middle + fl_rng_in(&g, -0.3, 0.3);
        fl_hull_submerged(&h, up, level, &w);
        const int closed = fl_prism_submerged(&as, up, level, &clipped);
        used += closed, left += !closed;
        h.prism.area = 0.0;
        fl_hull_submerged(&h, up, level, &clipped);
        assert_near_of(w.volume, clipped.volume, 1e-13, h.volume);
        assert_near_of(w.wetted_area, clipped.wetted_area, 1e-13, h.surface_area);
        assert_near_of(w.waterplane_area, clipped.waterplane_area, 1e-13, h.surface_area);
        if (closed) assert_near_of(v3_norm(v3_sub(w.centre, clipped.centre)), 0.0, 1e-12, p.size);
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
    assert_true(used > left / 4 && left > used / 4);
}

/* A hull that takes its corners from the core floats like one that stores them, in any orientation. */
static void a_hull_may_use_the_corners_of_its_core(void **state)
{
    (void)state;
    for (int t = 0; t < test_times(2000); t++) {
        fl_rng g = fl_rng_of(test_seed(), t, FL_RNG_TEST);
        fl_poly core, outer;
        fl_hull h, by;
        fl_submerged w, known;
        fl_waterplane a, b;
        fl_err err = {0};
        const double r = t % 5 ? fl_rng_in(&g, 0.01, 0.3) : 0.0;
        random_prism(&core, &g, 3 + t % 14);
        assert_int_equal(r > 0.0 ? fl_poly_offset(&outer, &core, r, &err) : fl_poly_copy(&outer, &core, &err),
                         0);
        assert_int_equal(fl_hull_make(&h, &outer, 0.0, &err), 0);
        assert_int_equal(fl_hull_make(&by, &outer, 0.0, &err), 0);
        assert_int_equal(fl_hull_borrow_core(&by, &core, r + 1e-9), 0);
        assert_true(by.shape == &outer && by.face_area);
        assert_int_equal(fl_hull_borrow_core(&by, &core, r), 1);
        assert_true(by.shape == &core && !by.face_area);
        const fl_vec3 up = v3_unit(v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)));
        const double level = v3_dot(up, h.centre) + fl_rng_in(&g, -2, 2);
        fl_hull_submerged(&h, up, level, &w);
        fl_hull_submerged(&by, up, level, &known);
        assert_near_of(w.volume, known.volume, 1e-12, h.volume);
        assert_near_of(w.wetted_area, known.wetted_area, 1e-12, h.surface_area);
        assert_near_of(w.waterplane_area, known.waterplane_area, 1e-12, h.surface_area);
        assert_near_of(v3_norm(v3_sub(w.centre, known.centre)) * w.volume, 0.0, 1e-12, outer.size * h.volume);
        fl_hull_waterplane(&h, up, level, &a);
        fl_hull_waterplane(&by, up, level, &b);
        assert_near_of(a.area, b.area, 1e-12, h.surface_area);
        assert_near_of(m3_col(a.second, 0).x, m3_col(b.second, 0).x, 1e-12, h.surface_area * h.surface_area);
        fl_hull_free(&h), fl_hull_free(&by);
        fl_poly_free(&core), fl_poly_free(&outer);
    }
}

/* A hull with too many corners, and one that is no prism, store their own. */
static void some_hulls_store_their_corners(void **state)
{
    (void)state;
    fl_vec3 xy[33];
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    for (int32_t n = 32; n <= 33; n++) {
        for (int k = 0; k < n; k++) xy[k] = v3(cos(2.0 * PI * k / n), sin(2.0 * PI * k / n), 0);
        assert_int_equal(fl_poly_prism(&p, n, xy, 0, 1, &err), 0);
        assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
        assert_int_equal(fl_hull_borrow_core(&h, &p, 0.0), n == 32);
        fl_hull_free(&h), fl_poly_free(&p);
    }
    const fl_vec3 corner[4] = {v3(0, 0, 0), v3(1, 0, 0), v3(0, 1, 0), v3(0, 0, 1)};
    const int32_t first[5] = {0, 3, 6, 9, 12}, loop[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
    assert_int_equal(fl_poly_make(&p, 4, corner, 4, first, loop, &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    assert_int_equal(fl_hull_borrow_core(&h, &p, 0.0), 0);
    assert_non_null(h.face_area);
    fl_hull_free(&h), fl_poly_free(&p);
}

/* A box is a prism in three ways, and floats as the flattest. Only right prisms are recognised. */
static void prisms_are_recognised(void **state)
{
    (void)state;
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    const fl_vec3 pyramid[5] = {v3(1, 1, 0), v3(-1, 1, 0), v3(-1, -1, 0), v3(1, -1, 0), v3(0, 0, 1)};
    const int32_t first[6] = {0, 4, 7, 10, 13, 16},
                  loop[16] = {3, 2, 1, 0, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    make_floe(&p, &h, 2, 0.5, 6);
    assert_near(h.prism.area, 12.0, 1e-15);
    assert_near(fabs(h.prism.e.y), 1.0, 0.0);
    for (int32_t v = 0; v < p.nv; v++) /* one cap inclined by very little */
        if (p.v[v].y > 0.0 && p.v[v].x > 0.0) p.v[v].y += 1e-9;
    fl_prism_of(&h.prism, &p);
    assert_true(fabs(h.prism.e.y) < 0.5 || h.prism.area == 0.0);
    fl_hull_free(&h);
    fl_poly_free(&p);
    assert_int_equal(fl_poly_make(&p, 5, pyramid, 5, first, loop, &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    assert_near(h.prism.area, 0.0, 0.0);
    fl_hull_free(&h);
    fl_poly_free(&p);
    /* a box of 2 x 2 x 1 m whose top is two triangles */
    const fl_vec3 box[8] = {v3(-1, -1, -0.5), v3(1, -1, -0.5), v3(1, 1, -0.5), v3(-1, 1, -0.5),
                            v3(-1, -1, 0.5),  v3(1, -1, 0.5),  v3(1, 1, 0.5),  v3(-1, 1, 0.5)};
    const int32_t begin[8] = {0, 4, 7, 10, 14, 18, 22, 26},
                  round[26] = {3, 2, 1, 0, 4, 5, 6, 4, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};
    fl_submerged w;
    assert_int_equal(fl_poly_make(&p, 8, box, 7, begin, round, &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    fl_hull_submerged(&h, v3(0, 0, 1), 0.1, &w);
    assert_near(w.volume, 2.4, 1e-15);
    assert_near(w.wetted_area, 8.8, 1e-15);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* The diagonal of a cube stands up and the water passes three vertices at once (H24). */
static void plane_through_vertices(void **state)
{
    (void)state;
    fl_poly p;
    fl_hull h;
    fl_submerged w;
    const double third = 1.0 / sqrt(3.0);
    make_floe(&p, &h, 1, 1, 1);
    fl_hull_submerged(&h, v3(third, third, third), -0.5 * third, &w);
    assert_near(w.volume, 1.0 / 6, 1e-15);
    assert_near(w.waterplane_area, sqrt(3.0) / 2, 1e-15);
    fl_hull_submerged(&h, v3(third, third, third), 0.5 * third, &w);
    assert_near(w.volume, 5.0 / 6, 1e-15);
    fl_hull_submerged(&h, v3(third, third, third), 0.0, &w);
    assert_near(w.volume, 0.5, 1e-15);
    assert_near(w.centre.x, -13.0 / 96, 1e-14);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

static void spheres_and_capsules(void **state)
{
    (void)state;
    const fl_vec3 v[2] = {{0, 0, -1}, {0, 0, 1}};
    fl_err err = {0};
    fl_poly ball, rod;
    fl_hull hb, hr;
    fl_submerged w;
    assert_int_equal(fl_poly_make(&ball, 1, &(fl_vec3){0}, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_poly_make(&rod, 2, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_hull_make(&hb, &ball, 0.5, &err), 0);
    assert_int_equal(fl_hull_make(&hr, &rod, 0.5, &err), 0);
    fl_hull_submerged(&hb, v3(0, 0.6, 0.8), 0.0, &w);
    assert_near(w.volume, PI / 12, 1e-15);
    assert_near(v3_dot(w.centre, v3(0, 0.6, 0.8)), -3.0 / 16, 1e-15);
    assert_near(w.wetted_area, PI / 2, 1e-15);
    assert_near(w.waterplane_area, PI / 4, 1e-15);
    fl_hull_submerged(&hb, v3(0, 0.6, 0.8), 0.5, &w);
    assert_near(w.volume, PI / 6, 1e-15);
    fl_hull_submerged(&hb, v3(0, 0.6, 0.8), -0.5, &w);
    assert_near(w.volume, 0.0, 0.0);
    /* upright: half a sphere and a piece of cylinder */
    fl_hull_submerged(&hr, v3(0, 0, 1), 0.25, &w);
    assert_near(w.volume, PI / 12 + PI / 4 * 1.25, 1e-14);
    assert_near(w.waterplane_area, PI / 4, 1e-14);
    assert_near(w.wetted_area, PI / 2 + PI * 1.25, 1e-14);
    assert_near(w.volume * w.centre.z, PI / 12 * (-1 - 3.0 / 16) + PI / 4 * 1.25 * -0.375, 1e-14);
    fl_hull_submerged(&hr, v3(0, 0, -1), 0.25, &w); /* and upside down */
    assert_near(w.volume, PI / 12 + PI / 4 * 1.25, 1e-14);
    /* lying, half submerged: half of everything */
    fl_hull_submerged(&hr, v3(0.6, 0.8, 0), 0.0, &w);
    assert_near(w.volume, 0.5 * hr.volume, 1e-14);
    assert_near(w.waterplane_area, 2.0 + PI / 4, 1e-14);
    assert_near(w.volume * v3_dot(w.centre, v3(0.6, 0.8, 0)), -2.0 * 2.0 / 3 * 0.125 - PI / 4 * 0.0625,
                1e-14);
    assert_near_of(w.centre.z, 0.0, 1e-15, 1.0);
    /* a quarter turn between the two: continuous */
    double last = 0.0;
    for (int k = 0; k <= 100000; k++) {
        const double t = 0.5 * PI * k / 100000;
        fl_hull_submerged(&hr, v3(sin(t), 0, cos(t)), 0.3, &w);
        if (k) assert_near_of(w.volume, last, 5e-5, 1.0);
        last = w.volume;
    }
    fl_hull_free(&hb);
    fl_hull_free(&hr);
    fl_poly_free(&ball);
    fl_poly_free(&rod);
}

static void bodies_that_cannot_float_are_refused(void **state)
{
    (void)state;
    const fl_vec3 v[4] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    const int32_t first[3] = {0, 4, 8}, loop[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    for (int nv = 1; nv <= 4; nv += nv == 2 ? 2 : 1) {
        fl_err err = {0};
        fl_poly p;
        fl_hull h = {.radius = 7.0};
        assert_int_equal(fl_poly_make(&p, nv, v, nv == 4 ? 2 : 0, first, loop, &err), 0);
        assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        assert_near(h.radius, 7.0, 0.0);
        fl_poly_free(&p);
    }
    {
        fl_err err = {0};
        fl_poly p;
        fl_hull h = {0};
        assert_int_equal(fl_poly_box(&p, v3(1, 1, 1), &err), 0);
        fl_alloc_fail_after(0);
        assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), -1);
        fl_alloc_fail_after(-1);
        assert_int_equal(err.code, FL_SYSTEM);
        fl_poly_free(&p);
    }
}

/* More vertices than stored heights: these are computed where needed. */
static void many_vertices(void **state)
{
    (void)state;
    enum { N = 100 };
    fl_vec3 xy[N];
    fl_err err = {0};
    fl_poly p;
    fl_hull h;
    fl_submerged w;
    for (int k = 0; k < N; k++) xy[k] = v3(cos(2 * PI * k / N), sin(2 * PI * k / N), 0);
    assert_int_equal(fl_poly_prism(&p, N, xy, -1, 1, &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    const double area = 0.5 * N * sin(2 * PI / N);
    fl_hull_submerged(&h, v3_unit(v3(0.3, 0, 1)), 0.0, &w);
    assert_near(w.volume, area, 1e-14);
    assert_near(w.waterplane_area, area * sqrt(1.09), 1e-14);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

static void drag_laws(void **state)
{
    (void)state;
    const fl_fluid sea = {.density = 1025, .force_coefficient = 0.005, .moment_coefficient = 0.004};
    fl_err err = {0};
    fl_poly p;
    assert_int_equal(fl_poly_box(&p, v3(5, 5, 0.5), &err), 0);
    assert_near(fl_drag_radius(&p, 0.0), 7.088723439378913, 1e-15);
    assert_near(fl_drag_radius(&p, 0.25), 7.338723439378913, 1e-15);
    fl_poly_free(&p);
    /* c |u|^2 is the force, c w^2 the moment */
    assert_near(fl_drag_force_constant(&sea, 100.0) * 25, 0.5 * 0.005 * 1025 * 100 * 25, 1e-15);
    assert_near(fl_drag_moment_constant(&sea, 100.0, 2.0) * 4, 0.5 * 0.004 * 1025 * 100 * 8 * 4, 1e-15);
}

/* One long step, or many short ones: m du/dt = -c u^2 is followed exactly, and no step length reverses the
 * motion (H38). */
static void drag_never_reverses(void **state)
{
    (void)state;
    double u = 3.0;
    for (int k = 0; k < 1000; k++) u *= fl_drag_decay_factor(5.0, 1.0, u, 0.05);
    assert_near(u, 3.0 * fl_drag_decay_factor(5.0, 1.0, 3.0, 50.0), 1e-12);
    for (int k = 0; k < 1000; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double f =
            fl_drag_decay_factor(pow(10, fl_rng_in(&g, -12, 12)), pow(10, fl_rng_in(&g, -9, 300)),
                                 pow(10, fl_rng_in(&g, -9, 9)), pow(10, fl_rng_in(&g, -9, 9)));
        assert_true(f >= 0.0 && f <= 1.0);
    }
    assert_near(fl_drag_decay_factor(0.3, 1.0, 0.0, 1.0), 1.0, 0.0);
}

static double wetted_and_dry_area(const fl_facet_cut *s)
{
    double total = 0.0;
    int32_t row = 0;
    for (int32_t k = 0; k < s->groups; row += s->group[k++].pieces)
        for (int32_t r = 0; r < s->group[k].pieces; r++)
            for (int l = 0; l < FL_SIMD_WIDTH; l++) total += s->piece[row + r].area[l];
    return total;
}

/* One step by all pieces one after another, in body axes, solved by elimination. */
static void drag_by_pieces(const fl_facet_cut *s, fl_facet_drag_law law, fl_vec3 mass, fl_vec3 inertia,
                           double h, fl_vec3 *v, fl_vec3 *w)
{
    const double M[6] = {mass.x, mass.y, mass.z, inertia.x, inertia.y, inertia.z},
                 y[6] = {v->x, v->y, v->z, w->x, w->y, w->z};
    double a[6][7] = {{0}};
    int32_t row = 0;
    for (int i = 0; i < 6; i++) a[i][i] = M[i], a[i][6] = M[i] * y[i];
    for (int32_t k = 0; k < s->groups; row += s->group[k++].pieces) {
        const fl_facet_group *f = &s->group[k];
        for (int32_t c = 0; c < f->pieces * FL_SIMD_WIDTH; c++) {
            const int l = (int)(c % FL_SIMD_WIDTH);
            const fl_facet_piece *p = &s->piece[row + c / FL_SIMD_WIDTH];
            const fl_vec3 r = fl_facet_piece_position(f, p, l), n = v3(f->n[0][l], f->n[1][l], f->n[2][l]);
            fl_vec3 U = v3(0, 0, 0);
            if (s->flow) {
                const fl_facet_flow *q = &s->flow[row + c / FL_SIMD_WIDTH];
                U = fl_facet_group_to_body(f, l, v3(q->u[0][l], q->u[1][l], q->u[2][l]));
            }
            const fl_vec3 u = v3_sub(v3_add(*v, v3_cross(*w, r)), U);
            const double un = v3_dot(u, n), skin = h * law.skin * p->area[l] * v3_norm(v3_madd(u, -un, n)),
                         form = h * law.form * p->area[l] * fmax(un, 0.0);
            for (int j = 0; j < 7; j++) { /* D of a column of J, or of U */
                const fl_vec3 e = v3(j % 3 == 0, j % 3 == 1, j % 3 == 2), x = j == 6  ? U
                                                                              : j < 3 ? e
                                                                                      : v3_cross(e, r);
                const fl_vec3 F = v3_madd(v3_scale(skin, x), (form - skin) * v3_dot(x, n), n),
                              T = v3_cross(r, F);
                const double add[6] = {F.x, F.y, F.z, T.x, T.y, T.z};
                for (int i = 0; i < 6; i++) a[i][j] += add[i];
            }
        }
    }
    for (int j = 0; j < 6; j++)
        for (int i = 0; i < 6; i++) {
            const double by = a[i][j] / a[j][j];
            for (int c = 0; c < 7 && i != j; c++) a[i][c] -= by * a[j][c];
        }
    *v = v3(a[0][6] / a[0][0], a[1][6] / a[1][1], a[2][6] / a[2][2]);
    *w = v3(a[3][6] / a[3][3], a[4][6] / a[4][4], a[5][6] / a[5][5]);
}

/* A box of 2 x 3 x 4 m under water: areas, and the exact decay along each axis for any step; no motion gains
 * energy. */
static void facet_drag_along_an_axis_is_exact(void **state)
{
    (void)state;
    fl_poly p;
    fl_hull h;
    fl_err err = {0};
    fl_facets k;
    fl_facet_cut skin, dry;
    const fl_facet_drag_law law = {2.0, 7.0};
    const fl_vec3 m = v3(100, 200, 300), I = v3(50, 60, 70);
    const double area[3] = {12, 8, 6};
    assert_int_equal(fl_poly_box(&p, v3(1, 1.5, 2), &err), 0);
    assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
    assert_int_equal(fl_facets_make(&k, &h, &err), 0);
    assert_int_equal(fl_facet_cut_make(&skin, &h, 0, 0, &err), 0);
    assert_int_equal(fl_facet_cut_make(&dry, &h, 1, 0, &err), 0);
    fl_facet_cut_update(&skin, &k, &h, v3(0, 0, 1), 10.0),
        fl_facet_cut_update(&dry, &k, &h, v3(0, 0, 1), 10.0);
    assert_near(wetted_and_dry_area(&skin), 52.0, 1e-14);
    assert_int_equal(dry.groups, 0);
    for (int axis = 0; axis < 3; axis++) {
        for (int e = -6; e < 12; e++) {
            const double step = pow(10, e), speed = axis == 1 ? -3.0 : 3.0, mass = 100.0 * (axis + 1);
            fl_vec3 v = v3(axis == 0 ? speed : 0, axis == 1 ? speed : 0, axis == 2 ? speed : 0), w = {0};
            fl_facet_drag(&skin, law, m, I, step, &v, &w);
            const double c = 2.0 * (52.0 - 2 * area[axis]) + 7.0 * area[axis];
            assert_near(v.x + v.y + v.z, speed / (1 + c / mass * 3.0 * step), 1e-12);
            assert_near_of(v3_norm(w), 0.0, 1e-13, 1.0);
        }
    }
    for (long t = 0; t < test_times(2000); t++) {
        fl_rng g = fl_rng_of(test_seed(), t, FL_RNG_TEST);
        double x[6];
        for (int j = 0; j < 6; j++) x[j] = fl_rng_normal(&g);
        fl_vec3 v = v3(x[0], x[1], x[2]), w = v3(x[3], x[4], x[5]);
        const double step = pow(10, fl_rng_in(&g, -9, 25));
        const double before = v3_dot(v, v3_mul(m, v)) + v3_dot(w, v3_mul(I, w));
        fl_facet_drag(&skin, law, m, I, step, &v, &w);
        const double after = v3_dot(v, v3_mul(m, v)) + v3_dot(w, v3_mul(I, w));
        assert_true(after <= before * (1 + 1e-12));
    }
    /* wet and dry areas add up, for every water level */
    for (int c = -25; c <= 25; c++) {
        const fl_vec3 up = v3_unit(v3(0.1 * c, 0.3, 1));
        fl_facet_cut_update(&skin, &k, &h, up, 0.1 * c), fl_facet_cut_update(&dry, &k, &h, up, 0.1 * c);
        assert_near(wetted_and_dry_area(&skin) + wetted_and_dry_area(&dry), 52.0, 1e-13);
    }
    fl_facet_cut_free(&skin), fl_facet_cut_free(&dry);
    fl_facets_free(&k);
    fl_hull_free(&h);
    fl_poly_free(&p);
}

/* Prisms of 3 to 9 sides along each body axis, or inclined to it, for every water level: the drag of sides by
 * closed formulae, of clipped facets and of whole ones equals that of all pieces one by one. It does not
 * depend on the previous state of the clipped surface. */
static void facet_drag_equals_that_of_the_pieces(void **state)
{
    (void)state;
    int32_t upright = 0, cut = 0;
    for (long t = 0; t < test_times(500); t++) {
        fl_rng g = fl_rng_of(test_seed(), t, FL_RNG_TEST);
        const int32_t sides = 3 + (int32_t)(t % 7), way = (int32_t)(t / 7 % 4);
        fl_vec3 xy[9];
        fl_err err = {0};
        fl_poly p;
        fl_hull h;
        fl_facets k;
        for (int32_t c = 0; c < sides; c++) {
            const double a = 2 * PI * (c + fl_rng_in(&g, 0.0, 0.5)) / sides;
            xy[c] = v3(cos(a), sin(a), 0);
        }
        assert_int_equal(fl_poly_prism(&p, sides, xy, -0.3, 0.3, &err), 0);
        const double z = t % 2 ? 1.0 : -1.0;
        const fl_mat3 axes[4] = {{{{0, z, 0}, {0, 0, z}, {1, 0, 0}}},
                                 {{{0, 0, z}, {1, 0, 0}, {0, z, 0}}},
                                 {{{1, 0, 0}, {0, z, 0}, {0, 0, z}}},
                                 q_matrix(q_of_vector(v3(0.3, 0.4, 0.5)))};
        fl_poly_to_frame(&p, v3(0.05, 0.02, 0.01), axes[way]);
        assert_int_equal(fl_hull_make(&h, &p, 0.0, &err), 0);
        assert_int_equal(fl_facets_make(&k, &h, &err), 0);
        assert_int_equal(k.cap_axis, way < 3 ? way : -1);
        for (int dry = 0; dry < 2; dry++) {
            fl_facet_cut s, fresh;
            assert_int_equal(fl_facet_cut_make(&s, &h, dry, (int)(t & 1), &err), 0);
            for (int look = 0; look < 6; look++) {
                const fl_vec3 tilt =
                    v3(fl_rng_in(&g, -0.1, 0.1), fl_rng_in(&g, -0.1, 0.1), look == 4 ? -1 : 1);
                const fl_vec3 up = look == 3 ? v3_unit(v3(fl_rng_normal(&g), fl_rng_normal(&g), 1))
                                             : v3_unit(m3_tmul(axes[way], tilt));
                const double level = look == 5 ? (dry ? -9 : 9) : fl_rng_in(&g, -0.1, 0.1);
                const fl_facet_drag_law law = {fl_rng_in(&g, 0, 3), fl_rng_in(&g, 0, 3)};
                const fl_vec3 m = v3(2, 3, 4), I = v3(0.5, 0.6, 0.7);
                fl_vec3 v = v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g)),
                        w = v3(fl_rng_normal(&g), fl_rng_normal(&g), fl_rng_normal(&g)), v2 = v, w2 = w,
                        v3rd = v, w3rd = w;
                fl_submerged wet;
                fl_facet_cut_update(&s, &k, &h, up, level);
                upright += s.cap_axis >= 0, cut += s.state == FL_FACET_CUT_GENERAL;
                fl_hull_submerged(&h, up, level, &wet);
                assert_near_of(wetted_and_dry_area(&s),
                               dry ? h.surface_area - wet.wetted_area : wet.wetted_area, 1e-13,
                               h.surface_area);
                if (!(t & 1)) {
                    assert_int_equal(fl_facet_cut_make(&fresh, &h, dry, 0, &err), 0);
                    fl_facet_cut_update(&fresh, &k, &h, up, level);
                    fl_facet_drag(&fresh, law, m, I, 0.3, &v3rd, &w3rd);
                    fl_facet_cut_free(&fresh);
                }
                for (int32_t r = 0; r < s.max_pieces * FL_SIMD_WIDTH && s.flow; r++)
                    for (int c = 0; c < 3; c++)
                        s.flow[r / FL_SIMD_WIDTH].u[c][r % FL_SIMD_WIDTH] = fl_rng_normal(&g);
                fl_facet_drag(&s, law, m, I, 0.3, &v, &w);
                drag_by_pieces(&s, law, m, I, 0.3, &v2, &w2);
                assert_near_of(v3_norm(v3_sub(v, v2)), 0.0, 1e-13, v3_norm(v2) + v3_norm(w2));
                assert_near_of(v3_norm(v3_sub(w, w2)), 0.0, 1e-13, v3_norm(v2) + v3_norm(w2));
                if (!(t & 1))
                    assert_memory_equal(&v, &v3rd, sizeof v), assert_memory_equal(&w, &w3rd, sizeof w);
            }
            fl_facet_cut_free(&s);
        }
        fl_facets_free(&k);
        fl_hull_free(&h);
        fl_poly_free(&p);
    }
    assert_true(upright > 2 * test_times(500) && cut > 2 * test_times(500));
}

static void currents_follow_their_profile(void **state)
{
    (void)state;
    fl_current c = {.velocity = {0.5, -0.25, 0}};
    for (int k = -10; k < 10; k++) {
        assert_near(fl_current_at(&c, k).x, 0.5, 0.0);
        assert_near(fl_current_at(&c, k).y, -0.25, 0.0);
    }
    c = (fl_current){.velocity = {0.5, -0.25, 0}, .kind = FL_PROFILE_POWER, .depth = 20, .exponent = 1.0 / 7};
    for (int k = 0; k < 20; k++) {
        assert_near(fl_current_at(&c, -k).x, 0.5 * pow(1.0 - k / 20.0, 1.0 / 7), 1e-15);
        assert_near(fl_current_at(&c, -k).y, -0.25 * pow(1.0 - k / 20.0, 1.0 / 7), 1e-15);
    }
    assert_true(fl_current_at(&c, 3).x == 0.5 && fl_current_at(&c, -20).x == 0.0 &&
                fl_current_at(&c, -21).x == 0.0);
    c.kind = FL_PROFILE_LINEAR;
    assert_near(fl_current_at(&c, -5).x, 0.375, 1e-15);
    assert_true(fl_current_at(&c, 1).x == 0.5 && fl_current_at(&c, -25).x == 0.0);
    assert_near(fl_current_max_speed(&c), sqrt(0.3125), 1e-15);
}

static void currents_are_interpolated_from_a_table(void **state)
{
    (void)state;
    static const char rising[] = "#current 1\n-20 0 0\n-5 0.4 0.1\n0.5 0.5 0\n",
                      falling[] = "#current 1\n0.5 0.5 0\n-5 0.4 0.1\n-20 0 0\n";
    for (int k = 0; k < 2; k++) {
        fl_current c = {0};
        fl_err err = {0};
        assert_int_equal(
            fl_current_read(&c, test_file("current", k ? falling : rising, sizeof rising - 1), &err), 0);
        assert_true(fl_current_at(&c, 2).x == 0.5 && fl_current_at(&c, -30).x == 0.0);
        assert_near(fl_current_at(&c, -12.5).x, 0.2, 1e-15);
        assert_near(fl_current_at(&c, -12.5).y, 0.05, 1e-15);
        assert_near(fl_current_at(&c, -5).x, 0.4, 1e-15);
        fl_current_free(&c);
    }
    fl_current c = {0};
    fl_err err = {0};
    static const char wrong[] = "#current 1\n0 1 0\n-1 1 0\n-0.5 1 0\n";
    assert_int_equal(fl_current_read(&c, test_file("current", wrong, sizeof wrong - 1), &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(strstr(err.text, ":4: height -0.5 m does not follow -1 m"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(upright_box),
        cmocka_unit_test(plane_through_faces),
        cmocka_unit_test(prism_buoyancy_has_closed_formulae),
        cmocka_unit_test(a_hull_may_use_the_corners_of_its_core),
        cmocka_unit_test(some_hulls_store_their_corners),
        cmocka_unit_test(prisms_are_recognised),
        cmocka_unit_test(plane_through_vertices),
        cmocka_unit_test(spheres_and_capsules),
        cmocka_unit_test(bodies_that_cannot_float_are_refused),
        cmocka_unit_test(many_vertices),
        cmocka_unit_test(drag_laws),
        cmocka_unit_test(drag_never_reverses),
        cmocka_unit_test(facet_drag_along_an_axis_is_exact),
        cmocka_unit_test(facet_drag_equals_that_of_the_pieces),
        cmocka_unit_test(currents_follow_their_profile),
        cmocka_unit_test(currents_are_interpolated_from_a_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
