/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The forces of two bodies in contact are the gradient of one energy, for bodies of any kind. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "narrow/closest_point.h"
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "contact/pair_geometry.h"
#include "support/small_world.h"
#include "support/shapes.h"

enum { CASES = 12 }; /* of each combination */

/* Step of the differences over the sum of the radii.  A point that becomes active inside a step of h shifts
 * the difference by k h/4 against a force of k s, s > 0.05 R: 5e-7.  The distance has an error of some
 * 1e-15 R / h = 1e-8. */
#define STEP 1e-7
#define GRADIENT_TOL 1e-6
#define BALANCE_TOL 1e-13

enum thing { POLYTOPE, FLAT, SEGMENT, POINT, FLOES, SOLID = FLOES, PLATE, CONE, SHELL, PLANE, THINGS };
static const char *const NAME[THINGS] = {"polytope",   "flat",      "segment",    "point", "solid part",
                                         "plate part", "cone part", "shell part", "plane"};

static void put_floe(lab *l, enum thing kind, int cuts, fl_rng *g, double radius)
{
    fl_err err = {0};
    fl_poly p = {0};
    const fl_vec3 zero = v3(0, 0, 0);
    if (kind == POLYTOPE) {
        shape_random_polytope(&p, g, cuts);
    } else if (kind == FLAT) {
        fl_vec3 xy[6];
        int32_t loop[12], n = 3 + (int32_t)fl_rng_in(g, 0.0, 4.0);
        const double a = fl_rng_in(g, 0.5, 2.0), b = fl_rng_in(g, 0.5, 2.0);
        for (int32_t k = 0; k < n; k++) {
            const double t = 6.283185307179586 * (k + fl_rng_in(g, 0.0, 0.7)) / n;
            xy[k] = v3(a * cos(t), b * sin(t), 0.0);
            loop[k] = k, loop[2 * n - 1 - k] = k;
        }
        assert_int_equal(fl_poly_make(&p, n, xy, 2, (int32_t[]){0, n, 2 * n}, loop, &err), 0);
    } else {
        const fl_vec3 v[2] = {v3(-fl_rng_in(g, 0.3, 2.0), 0, 0), v3(fl_rng_in(g, 0.3, 2.0), 0.1, 0)};
        assert_int_equal(fl_poly_make(&p, kind == SEGMENT ? 2 : 1, v, 0, NULL, NULL, &err), 0);
    }
    shape_move(&p, shape_rotation(g), v3(fl_rng_in(g, -1, 1), fl_rng_in(g, -1, 1), fl_rng_in(g, -1, 1)));
    lab_poly(l, &p, radius, zero, zero);
}

static void put_part(lab *l, enum thing kind, fl_rng *g)
{
    const double s = fl_rng_in(g, 0.7, 2.0), t = fl_rng_in(g, 0.3, 2.0);
    if (kind == SOLID) lab_wall(l, v3(-s, -t, -1), v3(s, t, 1), 2);
    if (kind == CONE)
        lab_cone(l, (fl_cone){v3(0, 0, -s), v3(0.3, 0.2, s), t, fl_rng_unit(g) < 0.3 ? 0.0 : 0.7});
    if (kind == SHELL) { /* an L */
        const fl_vec3 xy[6] = {v3(-s, -s, 0), v3(s, -s, 0), v3(s, 0, 0),
                               v3(0, 0, 0),   v3(0, s, 0),  v3(-s, s, 0)};
        lab_prism(l, 6, xy, -t, t);
    }
    if (kind == PLATE) {
        fl_err err = {0};
        const int32_t k = fl_surface_add(&l->surface, "plate", 5, &err);
        assert_true(k >= 0);
        fl_part *p = &l->surface.part[k];
        const fl_vec3 v[4] = {v3(-s, -t, 0), v3(s, -t, 0), v3(s, t, 0), v3(-s, t, 0)};
        for (int c = 0; c < 4; c++) assert_int_equal(fl_surface_vertex(p, v[c], &err), 0);
        assert_int_equal(fl_surface_triangle(p, 0, 1, 2, &err), 0);
        assert_int_equal(fl_surface_triangle(p, 0, 2, 3, &err), 0);
    }
    if (kind == PLANE) lab_set(l, "boundary.min=none none -1");
}

/* Evaluates the pair without history; axis NULL: without a separating axis. */
static fl_pair evaluate_from_start(fl_world *w, int32_t j, const fl_vec3 *axis)
{
    fl_pair p;
    fl_pair_init(w, &p, 0, j);
    if (axis) {
        p.axis = *axis;
        p.has_axis = 1;
    }
    fl_pair_evaluate(w, &p, 0, 0.0, 0);
    fl_pair_free(&p);
    assert_false(w->failed);
    return p;
}

static void displace_body(fl_world *w, int32_t i, fl_vec3 d) { w->b.x[i] = v3_add(w->b.x[i], d); }

static double energy_moved(fl_world *w, int32_t i, int32_t j, fl_vec3 d, fl_vec3 turn)
{
    const fl_vec3 x = w->b.x[i];
    const fl_quat q = w->b.q[i];
    displace_body(w, i, d);
    w->b.q[i] = q_mul(q_of_vector(turn), q);
    const double e = evaluate_from_start(w, j, NULL).energy;
    w->b.x[i] = x;
    w->b.q[i] = q;
    return e;
}

/* Minus the gradient of the energy when body i moves, and rotates about its centre. */
static void gradient(fl_world *w, int32_t i, int32_t j, double h, double arm, fl_vec3 *f, fl_vec3 *t)
{
    double a[6];
    for (int k = 0; k < 6; k++) {
        const double s = k < 3 ? h : h / arm;
        const fl_vec3 e = v3(k % 3 == 0 ? s : 0.0, k % 3 == 1 ? s : 0.0, k % 3 == 2 ? s : 0.0),
                      o = v3(0, 0, 0);
        const double up = energy_moved(w, i, j, k < 3 ? e : o, k < 3 ? o : e);
        const double down = energy_moved(w, i, j, k < 3 ? v3_neg(e) : o, k < 3 ? o : v3_neg(e));
        a[k] = -(up - down) / (2.0 * s);
    }
    *f = v3(a[0], a[1], a[2]);
    *t = v3(a[3], a[4], a[5]);
}

static double relative_error(fl_vec3 a, fl_vec3 b, double scale) { return v3_norm(v3_sub(a, b)) / scale; }

/* Gives body 0 the axes of body j with a small tilt: edges and faces of boxes and flats are then nearly
 * parallel, where the potential fades edges out. */
static void align(fl_world *w, int32_t j, fl_rng *g)
{
    const double tilt = pow(10.0, fl_rng_in(g, -5.0, -1.0));
    w->b.q[0] = q_mul(q_of_vector(v3_scale(tilt, shape_direction(g))), w->b.q[j]);
}

/* Moves body 0 from a distance onto j until they overlap by the share u of R; for u > 1 the cores overlap.
 * Returns 0 if they miss. */
static int approach(fl_world *w, int32_t j, fl_rng *g, double R, double u)
{
    const double far = w->b.bounding_radius[0] + w->b.bounding_radius[j] + 2.0 * R + 1.0;
    const int plane = j >= w->n && w->structure.piece[j - w->n].kind == FL_PIECE_PLANE;
    fl_vec3 dir = shape_direction(g);
    if (plane) dir.z = 1.0, dir = v3_unit(dir);
    const fl_vec3 aside = v3_scale(0.5 * w->b.bounding_radius[j], shape_direction(g));
    w->b.x[0] = v3_madd(v3_add(w->b.x[j], aside), far, dir);
    for (double path = 0.0; path < 2.0 * far; path += 0.02 * R) {
        displace_body(w, 0, v3_scale(-0.02 * R, dir));
        const fl_pair p = evaluate_from_start(w, j, NULL);
        if (u < 1.0 && p.cores_overlap) return 0;
        if (p.touching && p.overlap > u * R) return u > 1.0 ? p.cores_overlap : p.overlap < 0.95 * R;
    }
    return 0;
}

typedef struct {
    double gradient, balance, overlap;
    int tried, missed;
} tally;

static void one_case(enum thing a, enum thing b, int aligned, int deep, fl_rng *g, tally *t)
{
    lab l;
    const double ra = fl_rng_in(g, 0.05, 0.2), rb = b < FLOES ? fl_rng_in(g, 0.05, 0.2) : 0.0, R = ra + rb;
    lab_start(&l);
    put_floe(&l, a, aligned ? 0 : (int)fl_rng_in(g, 0.0, 8.0), g, ra);
    if (b < FLOES) put_floe(&l, b, aligned ? 0 : (int)fl_rng_in(g, 0.0, 8.0), g, rb);
    else put_part(&l, b, g);
    lab_make(&l, 1e-9);
    fl_world *w = &l.w;
    if (aligned) align(w, 1, g);
    if (!approach(w, 1, g, R, deep ? fl_rng_in(g, 1.1, 3.0) : fl_rng_in(g, 0.05, 0.8))) {
        t->missed++;
        lab_free(&l);
        return;
    }
    t->tried++;
    const fl_pair p = evaluate_from_start(w, 1, NULL);
    fl_vec3 f, ti, g1, tj;
    /* the depth of overlapping cores has a larger rounding error, and no point is as shallow as 0.05 R
     * there */
    const double step = (deep ? 10.0 : 1.0) * STEP * R;
    const double size = v3_norm(p.force), arm_i = w->b.bounding_radius[0] + ra,
                 arm_j = fmax(w->b.bounding_radius[1] + rb, arm_i);
    gradient(w, 0, 1, step, arm_i, &f, &ti);
    gradient(w, 1, 1, step, arm_j, &g1, &tj);
    const double e = fmax(
        fmax(relative_error(f, p.force, size), relative_error(g1, v3_neg(p.force), size)),
        fmax(relative_error(ti, p.torque_i, size * arm_i), relative_error(tj, p.torque_j, size * arm_j)));
    if (!(e < GRADIENT_TOL))
        printf("%s on %s: force %.9g, gradient error %.2e (f %.1e %.1e, t %.1e %.1e), %d places\n", NAME[a],
               NAME[b], size, e, relative_error(f, p.force, size), relative_error(g1, v3_neg(p.force), size),
               relative_error(ti, p.torque_i, size * arm_i), relative_error(tj, p.torque_j, size * arm_j),
               p.touching);
    t->gradient = fmax(t->gradient, e);
    fl_contact nearest;
    if (!deep && fl_pair_probe(w, &p, 0.0, &nearest))
        t->overlap = fmax(t->overlap, fabs(p.overlap + nearest.gap) / R);
    /* equal and opposite by construction; the torques about one point must cancel too */
    const fl_vec3 d = v3_sub(w->b.x[0], w->b.x[1]);
    const fl_vec3 sum = v3_add(v3_add(p.torque_i, p.torque_j), v3_cross(d, p.force));
    t->balance = fmax(t->balance, v3_norm(sum) / (size * (arm_i + arm_j)));
    for (int k = 0; k < 8; k++) {
        const fl_vec3 axis = shape_direction(g);
        const fl_pair o = evaluate_from_start(w, 1, &axis);
        assert_memory_equal(&o.force, &p.force, sizeof p.force);
        assert_memory_equal(&o.torque_i, &p.torque_i, sizeof p.torque_i);
        assert_memory_equal(&o.torque_j, &p.torque_j, sizeof p.torque_j);
        assert_memory_equal(&o.energy, &p.energy, sizeof p.energy);
    }
    lab_free(&l);
}

/* All combinations with separated cores; or those of bodies with a volume, with overlapping cores. */
static void verify_gradients(int deep)
{
    const int times = (int)test_times(CASES);
    double worst = 0.0, balance = 0.0;
    for (int a = 0; a < FLOES; a++) {
        for (int b = a; b < THINGS; b++) {
            if (deep && (a != POLYTOPE || (b != POLYTOPE && b != SOLID && b != CONE))) continue;
            tally t = {0};
            for (int k = 0; t.tried < times && k < 20 * times; k++) {
                fl_rng g = fl_rng_of(test_seed(), 1000 * (a * THINGS + b) + k, FL_RNG_TEST);
                one_case((enum thing)a, (enum thing)b, k & 1, deep, &g, &t);
            }
            printf("%-9s on %-10s %4d cases: gradient %.1e, balance %.1e, overlap %.1e\n", NAME[a], NAME[b],
                   t.tried, t.gradient, t.balance, t.overlap);
            worst = fmax(worst, t.gradient);
            balance = fmax(balance, t.balance);
            assert_int_equal(t.tried, times);
            /* a probe treats cones as polygons */
            assert_true(t.overlap < (b == CONE ? 0.01 : 1e-12));
        }
    }
    assert_true(worst < GRADIENT_TOL);
    assert_true(balance < BALANCE_TOL);
}

static void forces_are_the_gradient_of_one_energy(void **state)
{
    (void)state;
    verify_gradients(0);
}

static void forces_of_overlapping_cores_are_the_gradient(void **state)
{
    (void)state;
    verify_gradients(1);
}

/* Two equal boxes whose faces, edges and vertices coincide, in any frame: a point that lies on many planes,
 * each with its own rounding, belongs to one region, not to none or two. */
static void flush_bodies_do_not_depend_on_rounding(void **state)
{
    const fl_vec3 none = v3(0, 0, 0);
    (void)state;
    for (int k = 0; k < test_times(200); k++) {
        fl_rng g = fl_rng_of(test_seed(), 5000 + k, FL_RNG_TEST);
        const fl_quat q = shape_rotation(&g);
        const double over = k % 2 ? 0.001 : 0.02;
        double W[3];
        fl_vec3 f[3];
        lab l;
        lab_start(&l);
        for (int c = 0; c < 2; c++) {
            fl_poly p;
            fl_err err = {0};
            if (fl_poly_box(&p, v3(0.5, 0.5, 0.5), &err)) fail();
            shape_move(&p, q, c ? none : q_rotate(q, v3(0, 0, 3)));
            lab_poly(&l, &p, 0.05, none, none);
        }
        lab_make(&l, 1e-9);
        const fl_vec3 x = v3_add(l.w.b.x[1], q_rotate(q, v3(0, 0, 1.1 - over))),
                      aside = q_rotate(q, v3(1.1e-9, 0.7e-9, 0));
        for (int c = 0; c < 3; c++) { /* exactly there, and a nanometre to either side */
            lab_pose(&l.w, 0, v3_madd(x, c == 0 ? 0.0 : c == 1 ? 1.0 : -1.0, aside), l.w.b.q[1]);
            const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
            W[c] = p.energy, f[c] = p.force;
        }
        assert_true(fabs(W[0] / (0.5 * (W[1] + W[2])) - 1.0) < 1e-11);
        assert_true(v3_norm(v3_sub(f[0], v3_scale(0.5, v3_add(f[1], f[2])))) < 1e-11 * v3_norm(f[0]));
        lab_free(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(forces_are_the_gradient_of_one_energy),
                                       cmocka_unit_test(forces_of_overlapping_cores_are_the_gradient),
                                       cmocka_unit_test(flush_bodies_do_not_depend_on_rounding)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
