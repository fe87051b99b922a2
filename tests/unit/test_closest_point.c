/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "support/near.h"
#include <math.h>
#include "narrow/closest_point.h"
#include "support/shapes.h"

#define TOL 1e-14

/* A closest point certifies itself: p belongs to the body, x - p = d n, and no vertex lies beyond the plane
 * across n through p. Inside, d is the largest height over a face. */
static void check_closest_point(const fl_poly *p, fl_vec3 x, fl_closest_point q)
{
    const double size = p->size + v3_norm(x);
    double top = -INFINITY;
    for (int32_t f = 0; f < p->nf; f++) top = fmax(top, v3_dot(p->n[f], x) - p->c[f]);
    assert_near_of(v3_norm(q.n), 1.0, TOL, 1.0);
    assert_near_of(v3_norm(v3_sub(x, v3_madd(q.p, q.d, q.n))), 0.0, 4 * TOL, size);
    if (p->nf > 2 && top <= 0.0) {
        assert_near_of(q.d, top, TOL, size);
        return;
    }
    assert_true(q.d >= 0.0);
    for (int32_t f = 0; f < p->nf; f++) assert_true(v3_dot(p->n[f], q.p) - p->c[f] <= 4 * TOL * size);
    for (int32_t v = 0; v < p->nv; v++)
        assert_true(q.d * v3_dot(q.n, v3_sub(p->v[v], q.p)) <= 16 * TOL * size * size);
}

static void closest_points_of_polyhedra_are_certified(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(300); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_poly p = {0};
        if (k % 10) shape_random(&p, &g);
        else shape_regular(&p, k % 20 ? 20 : 8, 1.0);
        for (int m = 0; m < 50; m++) {
            const fl_vec3 x = v3_scale(pow(10.0, fl_rng_in(&g, -2, 1.5)), shape_direction(&g));
            check_closest_point(&p, x, fl_closest_on_poly(&p, x));
            /* over a vertex, an edge, a face, and on them */
            const fl_vec3 v = p.v[(int)fl_rng_in(&g, 0, p.nv)];
            check_closest_point(&p, v3_madd(v, 0.1, x), fl_closest_on_poly(&p, v3_madd(v, 0.1, x)));
            const fl_edge e = p.edge[(int)fl_rng_in(&g, 0, p.ne)];
            const fl_vec3 mid = v3_lerp(p.v[e.a], p.v[e.b], fl_rng_unit(&g));
            check_closest_point(&p, mid, fl_closest_on_poly(&p, mid));
        }
        fl_poly_free(&p);
    }
}

/* |d(x) - d(y)| <= |x - y|, and d crosses zero on the way from outside to inside. */
static void distance_is_continuous_through_zero(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(100); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_poly p = {0};
        shape_random_polytope(&p, &g, 6);
        const fl_vec3 dir = shape_direction(&g), from = v3_scale(3.0, dir);
        double before = INFINITY, lowest = INFINITY;
        fl_vec3 at = from;
        for (int m = 0; m <= 3000; m++) {
            const fl_vec3 x = v3_madd(from, -1e-3 * m, dir);
            const double d = fl_closest_on_poly(&p, x).d;
            if (m) assert_true(fabs(d - before) <= v3_norm(v3_sub(x, at)) * (1 + 1e-9));
            before = d;
            at = x;
            lowest = fmin(lowest, d);
        }
        assert_true(lowest < -0.05);
        fl_poly_free(&p);
    }
}

/* A distance is defined also in the plane of a flat polygon: floes of one thickness float at one height. */
static void flat_polygons_have_no_interior(void **state)
{
    (void)state;
    const fl_vec3 v[4] = {v3(-1, -1, 0), v3(1, -1, 0), v3(1, 1, 0), v3(-1, 1, 0)};
    const int32_t first[3] = {0, 4, 8}, loop[8] = {0, 1, 2, 3, 3, 2, 1, 0};
    fl_err err = {0};
    fl_poly p = {0};
    assert_int_equal(fl_poly_make(&p, 4, v, 2, first, loop, &err), 0);
    fl_closest_point q = fl_closest_on_poly(&p, v3(1.5, 0.25, 0));
    assert_near(q.d, 0.5, TOL);
    assert_near(q.n.x, 1.0, TOL);
    q = fl_closest_on_poly(&p, v3(4, 5, 0));
    assert_near(q.d, 5.0, TOL);
    assert_near(q.n.y, 0.8, TOL);
    q = fl_closest_on_poly(&p, v3(0.5, 0.25, -0.125));
    assert_near(q.d, 0.125, TOL);
    assert_near(q.n.z, -1.0, TOL);
    q = fl_closest_on_poly(&p, v3(0.5, 0.25, 0));
    assert_true(q.d == 0.0);
    assert_near(fabs(q.n.z), 1.0, TOL);
    fl_poly_free(&p);
}

static void points_and_segments_are_bodies(void **state)
{
    (void)state;
    const fl_vec3 v[2] = {v3(0, 0, 0), v3(2, 0, 0)};
    fl_err err = {0};
    fl_poly point = {0}, segment = {0};
    assert_int_equal(fl_poly_make(&point, 1, v, 0, NULL, NULL, &err), 0);
    assert_int_equal(fl_poly_make(&segment, 2, v, 0, NULL, NULL, &err), 0);
    assert_near(fl_closest_on_poly(&point, v3(3, 4, 0)).d, 5.0, TOL);
    assert_near(fl_closest_on_poly(&segment, v3(1, 0.5, 0)).d, 0.5, TOL);
    assert_near(fl_closest_on_poly(&segment, v3(5, 4, 0)).d, 5.0, TOL);
    const fl_closest_point q = fl_closest_on_poly(&point, v3(0, 0, 0)); /* no unique direction: z */
    assert_true(q.d == 0.0 && q.n.z == 1.0);
    fl_poly_free(&point);
    fl_poly_free(&segment);
}

static double cone_support(double r0, double r1, double h, fl_vec3 n)
{
    const double rho = sqrt(n.x * n.x + n.y * n.y);
    return fmax(r0 * rho, r1 * rho + h * n.z);
}

static void closest_points_of_cones_are_certified(void **state)
{
    (void)state;
    for (int k = 0; k < test_times(20000); k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double r0 = k % 7 ? fl_rng_in(&g, 0.2, 2) : 0.0, r1 = k % 5 ? fl_rng_in(&g, 0.2, 2) : 0.0,
                     h = fl_rng_in(&g, 0.2, 3);
        if (r0 + r1 == 0.0) continue;
        const fl_vec3 x =
            v3(fl_rng_in(&g, -3, 3), k % 11 ? fl_rng_in(&g, -3, 3) : 0.0, fl_rng_in(&g, -2, h + 2));
        const fl_closest_point q = fl_closest_on_cone(r0, r1, h, x);
        assert_near_of(v3_norm(q.n), 1.0, TOL, 1.0);
        assert_near_of(v3_norm(v3_sub(x, v3_madd(q.p, q.d, q.n))), 0.0, TOL, 4.0);
        /* the body lies behind the plane across n through p; this makes d the distance, inside and outside */
        if (fabs(q.d) > 1e-6) assert_near_of(v3_dot(q.n, q.p), cone_support(r0, r1, h, q.n), 1e-9, 1.0);
        if (q.d >= 0.0) continue;
        for (int m = 0; m < 20; m++) { /* no other way out is shorter */
            const fl_vec3 n = shape_direction(&g);
            assert_true(cone_support(r0, r1, h, n) - v3_dot(n, x) >= -q.d - TOL);
        }
    }
}

static void ties_of_cones_are_resolved_uniquely(void **state)
{
    (void)state;
    fl_closest_point q =
        fl_closest_on_cone(0.5, 0.5, 2.0, v3(0, 0, 1)); /* on the axis: the side is closest, along x */
    assert_near(q.d, -0.5, TOL);
    assert_near(q.n.x, 1.0, TOL);
    q = fl_closest_on_cone(1.0, 1.0, 1.0, v3(0, 0, 0.5)); /* both ends are equally close: the lower */
    assert_near(q.d, -0.5, TOL);
    assert_near(q.n.z, -1.0, TOL);
    q = fl_closest_on_cone(0.5, 0.5, 2.0, v3(0, 0, 2.5)); /* over the axis */
    assert_near(q.d, 0.5, TOL);
    assert_near(q.n.z, 1.0, TOL);
    q = fl_closest_on_cone(0.5, 0.5, 2.0, v3(0.5, 0, 2.25)); /* over the rim */
    assert_near(q.d, 0.25, TOL);
    assert_near(q.n.z, 1.0, TOL);
    q = fl_closest_on_cone(0.5, 0.5, 2.0,
                           v3(0.5, 0, 2.0)); /* on the rim: the direction is not unique, but one is chosen */
    assert_true(q.d <= 0.0 && fabs(q.d) < TOL);
    assert_near(v3_norm(q.n), 1.0, TOL);
    q = fl_closest_on_cone(1.0, 0.0, 1.0, v3(0, 0, 1.5)); /* over the apex */
    assert_near(q.d, 0.5, TOL);
    assert_near(q.n.z, 1.0, TOL);
    q = fl_closest_on_cone(1.0, 0.0, 1.0, v3(0, 0, 1.0)); /* the apex itself */
    assert_true(fabs(q.d) < TOL);
    assert_near(v3_norm(q.n), 1.0, TOL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closest_points_of_polyhedra_are_certified),
        cmocka_unit_test(distance_is_continuous_through_zero),
        cmocka_unit_test(flat_polygons_have_no_interior),
        cmocka_unit_test(points_and_segments_are_bodies),
        cmocka_unit_test(closest_points_of_cones_are_certified),
        cmocka_unit_test(ties_of_cones_are_resolved_uniquely),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
