/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Area vectors of cones inside floes: closed forms, and random poses against cones of many flat facets, each
 * clipped exactly. */
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "failure/area_vector.h"
#include "failure/cone_area.h"
#include "support/near.h"
#include "support/shapes.h"

enum { FACETS = 360, CORNERS = 80 };

static const fl_mat3 ONE = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/* A box of half sides h about x. */
static fl_half_spaces box_at(fl_vec3 x, fl_vec3 h)
{
    fl_half_spaces a;
    fl_poly p;
    fl_err err = {0};
    if (fl_poly_box(&p, h, &err)) fail_msg("%s", err.text);
    fl_half_spaces_of(&a, &p, 0.0, &ONE, x);
    fl_poly_free(&p);
    return a;
}

static fl_piece cone_of(double r0, double r1, double h)
{
    return (fl_piece){.kind = FL_PIECE_CONE, .r0 = r0, .r1 = r1, .h = h};
}

/* A floe with an upright side at x = d, its top and bottom at z = 4 and 5. */
static void side_on_a_cylinder(void **state)
{
    (void)state;
    const fl_piece c = cone_of(2.0, 2.0, 10.0);
    for (int k = 1; k < 20; k++) {
        const double d = 2.0 - 0.2 * k, w = sqrt(4.0 - d * d), phi = acos(d / 2.0);
        const fl_half_spaces a = box_at(v3(d + 6, 0, 4.5), v3(6, 8, 0.5));
        double area;
        fl_vec3 S = fl_cone_area_vector(&a, &c, v3(0, 0, 0), &area);
        assert_near(S.x, 2.0 * w, 1e-14);
        assert_near_of(v3_norm(v3(0, S.y, S.z)), 0.0, 1e-14, 1.0);
        assert_near(area, 2.0 * 2.0 * phi, 1e-14);
        /* what faces x does not grow beyond the diameter; what faces y is a quarter at most */
        S = fl_cone_area_vector(&a, &c, v3(1, 0, 0), &area);
        assert_near(S.x, d > 0.0 ? 2.0 * w : 4.0, 1e-14);
        S = fl_cone_area_vector(&a, &c, v3(0, 1, 0), &area);
        assert_near(S.y, 2.0 - d, 1e-13);
    }
}

/* The whole side: of a floe around it, and of one that encloses it. */
static void whole_cone(void **state)
{
    (void)state;
    const double r0[3] = {2.0, 2.0, 1.5}, r1[3] = {2.0, 1.0, 0.0}, h[3] = {10, 3, 2};
    double area;
    for (int k = 0; k < 3; k++) {
        const fl_piece c = cone_of(r0[k], r1[k], h[k]);
        fl_half_spaces a = box_at(v3(0, 0, 0), v3(6, 6, 20));
        fl_vec3 S = fl_cone_area_vector(&a, &c, v3(0, 0, 0), &area);
        assert_near(area, PI * (r0[k] + r1[k]) * hypot(h[k], r1[k] - r0[k]), 1e-14);
        assert_near_of(S.z, PI * (r0[k] * r0[k] - r1[k] * r1[k]), 1e-14, 10.0);
        assert_near_of(hypot(S.x, S.y), 0.0, 1e-14, 10.0);
        S = fl_cone_area_vector(&a, &c, v3(0, -1, 0), &area);
        assert_near(S.y, -(r0[k] + r1[k]) * h[k], 1e-14);
        a = box_at(v3(0, 0, 1), v3(6, 6, 0.5));
        fl_cone_area_vector(&a, &c, v3(0, 0, 0), &area);
        const double low = r0[k] + 0.5 / h[k] * (r1[k] - r0[k]), high = r0[k] + 1.5 / h[k] * (r1[k] - r0[k]);
        assert_near(area, PI * (low + high) * hypot(1, high - low), 1e-14);
    }
}

/* A square floe a little narrower than the pile: four arcs, near its corners. */
static void four_arcs(void **state)
{
    (void)state;
    const fl_piece c = cone_of(1.0, 1.0, 10.0);
    const double a = 0.8, half = 0.25 * PI - acos(a);
    const fl_half_spaces q = box_at(v3(0, 0, 5), v3(a, a, 0.25));
    double area;
    fl_vec3 S = fl_cone_area_vector(&q, &c, v3(0, 0, 0), &area);
    assert_near(area, 0.5 * 4.0 * 2.0 * half, 1e-13);
    assert_near_of(v3_norm(S), 0.0, 1e-14, 1.0);
    S = fl_cone_area_vector(&q, &c, v3(1, 0, 0), &area);
    assert_near(S.x, 0.5 * 2.0 * 2.0 * sin(half) * sqrt(0.5), 1e-13);
    assert_near_of(S.y, 0.0, 1e-14, 1.0);
    S = fl_cone_area_vector(&q, &c, v3_unit(v3(1, 1, 0)), &area);
    assert_near(S.x, S.y, 1e-13);
    assert_near(area, 0.5 * 4.0 * half, 1e-13); /* one, and half of two */
}

/* A side of an upright floe on a cone: hyperbolas; at depth d from the axis and between z0 and z1 the area
 * that faces x is that of the chords. */
static void side_on_a_cone(void **state)
{
    (void)state;
    const fl_piece c = cone_of(2.0, 1.0, 4.0);
    for (int k = 0; k < 10; k++) {
        const double d = 0.2 + 0.13 * k;
        const fl_half_spaces a = box_at(v3(d + 6, 0, 1.0), v3(6, 8, 0.5));
        double chords = 0.0;
        enum { FINE = 20000 };
        for (int m = 0; m < FINE; m++) {
            const double r = 2.0 - 0.25 * (0.5 + (m + 0.5) / FINE);
            chords += 2.0 * sqrt(fmax(r * r - d * d, 0.0)) / FINE;
        }
        assert_near(fl_cone_area_vector(&a, &c, v3(0, 0, 0), NULL).x, chords, d < 1.6 ? 1e-9 : 1e-6);
    }
}

/* A pile or a cone goes through a floe around it, not through one at its side; a floor does not. */
static void what_goes_through(void **state)
{
    (void)state;
    const fl_vec3 up = v3(0, 0, 1);
    const fl_piece pile = cone_of(1.0, 1.0, 10.0), cone = cone_of(3.0, 1.0, 3.0);
    fl_piece floor = {.kind = FL_PIECE_SOLID};
    fl_err err = {0};
    if (fl_poly_box(&floor.core, v3(50, 50, 5), &err)) fail_msg("%s", err.text);
    const fl_half_spaces around = box_at(v3(1, 1, 2), v3(6, 6, 0.5)),
                         beside = box_at(v3(5, 0, 2), v3(4.5, 6, 0.5)),
                         above = box_at(v3(1, 1, 5.4), v3(6, 6, 0.5));
    assert_true(fl_area_is_closed(&around, &pile, up));
    assert_true(fl_area_is_closed(&around, &cone, up));
    assert_false(fl_area_is_closed(&beside, &pile, up));
    assert_false(fl_area_is_closed(&beside, &cone, up));
    assert_false(fl_area_is_closed(&above, &floor, up));
    assert_near(fl_area_vector_of_piece(&above, &floor, v3(0, 0, 0)).z, 144.0, 1e-14);
    fl_poly_free(&floor.core);
}

/* --- random poses --------------------------------------------------------------------------------- */

static int clip(const fl_half_spaces *a, fl_vec3 *v, int n)
{
    fl_vec3 w[CORNERS];
    for (int k = 0; k < a->n && n > 0; k++) {
        int m = 0;
        for (int e = 0; e < n; e++) {
            const fl_vec3 x = v[e], y = v[(e + 1) % n];
            const double at = v3_dot(a->normal[k], x) - a->c[k], then = v3_dot(a->normal[k], y) - a->c[k];
            if (at <= 0.0) w[m++] = x;
            if ((at <= 0.0) != (then <= 0.0)) w[m++] = v3_lerp(x, y, at / (at - then));
        }
        memcpy(v, w, (size_t)m * sizeof *v);
        n = m;
    }
    return n;
}

/* S of a cone of flat facets of the same cross-section. */
static fl_vec3 facets_inside(const fl_half_spaces *a, const fl_piece *c, int facets, fl_vec3 facing,
                             double *area)
{
    const double turn = 2.0 * PI / facets, larger = sqrt(turn / sin(turn));
    fl_vec3 all = v3(0, 0, 0);
    *area = 0.0;
    for (int k = 0; k < facets; k++) {
        const double c0 = larger * cos(k * turn), s0 = larger * sin(k * turn),
                     c1 = larger * cos((k + 1) * turn), s1 = larger * sin((k + 1) * turn);
        fl_vec3 v[CORNERS] = {v3(c->r0 * c0, c->r0 * s0, 0), v3(c->r0 * c1, c->r0 * s1, 0),
                              v3(c->r1 * c1, c->r1 * s1, c->h), v3(c->r1 * c0, c->r1 * s0, c->h)};
        const int n = clip(a, v, 4);
        fl_vec3 S = v3(0, 0, 0);
        for (int m = 1; m + 1 < n; m++)
            S = v3_madd(S, 0.5, v3_cross(v3_sub(v[m], v[0]), v3_sub(v[m + 1], v[0])));
        if (v3_dot(S, facing) < 0.0) continue;
        all = v3_add(all, S);
        *area += v3_norm(S);
    }
    return all;
}

static void random_poses(void **state)
{
    (void)state;
    const long cases = test_times(1000);
    double worst = 0.0;
    long inside = 0;
    for (long k = 0; k < cases; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_poly p;
        fl_half_spaces a;
        shape_random(&p, &g);
        const double r0 = fl_rng_in(&g, 0.1, 2.0), kind = fl_rng_unit(&g), ratio = fl_rng_unit(&g);
        const fl_piece c = cone_of(kind > 0.9 ? r0 * ratio : r0,
                                   kind < 0.5   ? r0
                                   : kind > 0.9 ? r0
                                                : r0 * ratio,
                                   fl_rng_in(&g, 0.5, 6.0));
        const double phi = fl_rng_in(&g, 0.0, 2.0 * PI), out = fl_rng_in(&g, 0.0, 2.0),
                     tilt = fl_rng_unit(&g);
        /* upright, nearly so, or any */
        fl_quat q = shape_rotation(&g);
        if (tilt < 0.3) q.x = q.y = 0.0;
        else if (tilt < 0.6) q.x *= 0.02, q.y *= 0.02;
        if (tilt < 0.6) q = q_unit(q);
        const fl_mat3 M = q_matrix(q);
        fl_half_spaces_of(&a, &p, 0.01, &M,
                          v3(out * r0 * cos(phi), out * r0 * sin(phi), fl_rng_in(&g, 0.0, c.h)));
        const fl_vec3 facing = fl_rng_unit(&g) < 0.5 ? v3(0, 0, 0) : shape_direction(&g);
        double area, expected, off = INFINITY;
        const fl_vec3 S = fl_cone_area_vector(&a, &c, facing, &area);
        /* facets err most where a floe only grazes the cone: those poses again with more of them */
        const double unit = (c.r0 + c.r1) * c.h * (2.0 * PI / FACETS) * (2.0 * PI / FACETS);
        for (int facets = FACETS; facets <= 64 * FACETS && off > 0.2; facets *= 8) {
            const fl_vec3 T = facets_inside(&a, &c, facets, facing, &expected);
            off = (v3_norm2(facing) > 0.0 ? fabs(v3_dot(facing, v3_sub(S, T)))
                                          : fmax(v3_norm(v3_sub(S, T)), fabs(area - expected))) /
                  unit;
        }
        inside += expected > 0.0;
        if (off > 0.2)
            print_error("seed %llu case %ld: %g of %g\n", (unsigned long long)test_seed(), k, off * unit,
                        expected);
        worst = fmax(worst, off);
        fl_poly_free(&p);
    }
    print_message("%ld poses, %ld in contact: largest difference %g of the error of a facet\n", cases, inside,
                  worst);
    assert_true(worst < 0.2);
    assert_true(inside > cases / 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(side_on_a_cylinder), cmocka_unit_test(whole_cone),
                                       cmocka_unit_test(four_arcs),          cmocka_unit_test(side_on_a_cone),
                                       cmocka_unit_test(what_goes_through),  cmocka_unit_test(random_poses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
