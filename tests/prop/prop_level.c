/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Floes of one thickness float with their edges at one level, and neighbouring floes that were cut apart
 * face each other, so edges and faces are parallel up to rounding.  Rounding then decides which of two
 * features is the nearer one; the force must not depend on it. */
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include "contact/pair_force.h"
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "support/small_world.h"
#include "support/shapes.h"

enum { CASES = 600, TURNS = 6 };

/* Relative to the force: differences between two Gauss rules (edge_integral.h), and between an edge that is
 * cut in two and one that is not, whose points are damped along their mean directions. */
#define LEFT 1e-7

enum thing { FLOE, WALL, CYLINDER, THINGS };
static const char *const NAME[THINGS] = {"floe", "wall", "cylinder"};

/* 0, or any magnitude up to the first. */
static double zero_or_tiny(fl_rng *g, double lo, double hi)
{
    if (fl_rng_unit(g) < 0.25) return 0.0;
    const double x = pow(10.0, -fl_rng_in(g, lo, hi));
    return fl_rng_unit(g) < 0.5 ? -x : x;
}

static fl_pair evaluate_from_start(fl_world *w)
{
    fl_pair p;
    fl_pair_init(w, &p, 0, 1);
    fl_pair_evaluate(w, &p, 0, 0.0, 1);
    fl_pair_free(&p);
    assert_false(w->failed);
    return p;
}

/* Change of force and torque by a displacement and rotation of d, over the change that stiffness and LEFT
 * allow. */
static double force_jump(fl_world *w, const fl_pair *p, fl_rng *g)
{
    const double d = pow(10.0, -fl_rng_in(g, 11.0, 15.5)), arm = w->b.bounding_radius[0];
    const fl_vec3 x = w->b.x[0];
    const fl_quat q = w->b.q[0];
    lab_pose(w, 0, v3_madd(x, d, shape_direction(g)), q_mul(q_of_vector(v3_scale(d, shape_direction(g))), q));
    w->b.v[0] = v3(-0.5, 0.1, 0.02), w->b.w[0] = v3(0.01, 0.05, 0.2);
    const fl_pair o = evaluate_from_start(w);
    w->b.x[0] = x, w->b.q[0] = q;
    const double off = v3_norm(v3_sub(o.force, p->force)) + v3_norm(v3_sub(o.torque_i, p->torque_i)) / arm;
    const double stiff = p->omega2_i * w->b.m[0] * (1.0 + arm);
    return off / (10.0 * stiff * (d + 1e-15) + LEFT * v3_norm(p->force));
}

/* Body 0 with a face on the left, against an object with a face on the right at x = 0. */
static void one_case(enum thing b, fl_rng *g, int *contacts, double *worst)
{
    const double R = 0.1, h = 0.3, depth = pow(10.0, -fl_rng_in(g, 1.5, 5.0));
    const double a = fl_rng_in(g, 0.5, 2.0), wide = fl_rng_in(g, 0.5, 2.0),
                 high = fl_rng_unit(g) < 0.7 ? h : 0.25;
    const fl_vec3 zero = v3(0, 0, 0);
    lab l;
    lab_start(&l);
    lab_set(&l, "contact.restitution=0.3");
    lab_box(&l, v3(5, 0, 0), v3(1.0, a, h), b == FLOE ? 0.5 * R : R, q_one(), zero, zero);
    if (b == FLOE) lab_box(&l, v3(-1, 0, 0), v3(1.0, wide, high), 0.5 * R, q_one(), zero, zero);
    if (b == WALL) lab_wall(&l, v3(-1, -wide, -high), v3(0, wide, high), 1 + (int)fl_rng_in(g, 0.0, 3.0));
    if (b == CYLINDER) lab_cone(&l, (fl_cone){v3(-1, 0, -2), v3(-1, 0, 2), 1.0, 1.0});
    lab_make(&l, 1e-9);
    fl_world *w = &l.w;
    const double turned = zero_or_tiny(g, 2.0, 17.0);
    const int level = fl_rng_unit(g) < 0.3;
    const fl_vec3 turn =
        v3(level ? 0.0 : zero_or_tiny(g, 5.0, 17.0), level ? 0.0 : zero_or_tiny(g, 5.0, 17.0), turned);
    const double y = fl_rng_unit(g) < 0.2 ? a - wide : fl_rng_in(g, -1.0, 1.0);
    lab_pose(w, 0, v3(1.0 - depth + fabs(turned) * a, y, level ? 0.0 : zero_or_tiny(g, 5.0, 17.0)),
             q_mul(q_of_vector(turn), w->b.q[0]));
    w->b.v[0] = v3(-0.5, 0.1, 0.02), w->b.w[0] = v3(0.01, 0.05, 0.2);
    const fl_pair p = evaluate_from_start(w);
    if (p.touching) ++*contacts;
    for (int k = 0; k < TURNS && p.touching; k++) {
        const double e = force_jump(w, &p, g);
        if (!(e < 1.0))
            printf("%s: jumps by %.2e of what is allowed, depth %.1e, turned %.1e %.1e %.1e, y %.3g\n",
                   NAME[b], e, depth, turn.x, turn.y, turn.z, y);
        *worst = fmax(*worst, e);
    }
    lab_free(&l);
}

static void rounding_does_not_change_forces(void **state)
{
    (void)state;
    for (int b = FLOE; b < THINGS; b++) {
        int contacts = 0;
        double worst = 0.0;
        for (int c = 0; c < CASES; c++) {
            fl_rng g = fl_rng_of(17, c, (uint32_t)b);
            one_case((enum thing)b, &g, &contacts, &worst);
        }
        printf("floe on %-8s %4d cases: jumps by %.2f of what is allowed\n", NAME[b], contacts, worst);
        assert_true(contacts > CASES / 2);
        assert_true(worst < 1.0);
    }
}

/* Neighbouring floes that were cut apart overlap by a rounding error here and there: that is no contact, or
 * one with the stiffness of its area. */
static void a_rounding_has_no_stiffness(void **state)
{
    (void)state;
    for (int k = 0; k < 1300; k++) {
        fl_rng g = fl_rng_of(9, k, FL_RNG_TEST);
        const double a = fl_rng_in(&g, 0.3, 3), overlap = 4e-15 * a * pow(2.0, k % 13);
        const fl_quat q = shape_rotation(&g);
        const fl_vec3 x = v3(fl_rng_in(&g, -500, 500), fl_rng_in(&g, -500, 500), 0), half = v3(a, a, a),
                      none = v3(0, 0, 0);
        lab l;
        lab_start(&l);
        lab_box(&l, x, half, 0.05, q, none, none);
        lab_box(&l, v3_add(x, q_rotate(q, v3(2 * a - overlap, 0.1 * a, 0.2 * a))), half, 0.05, q, none, none);
        lab_make(&l, 1e-9);
        const fl_pair p = lab_evaluate_pair(&l.w, 0, 1);
        const double stiff = l.w.b.m[0] / (l.w.dt_critical * l.w.dt_critical);
        assert_true(isfinite(v3_norm(p.force)) && isfinite(v3_norm(p.torque_i)));
        if (p.touching) assert_true(stiff > 0.4e9 * a && stiff < 1.6e9 * a);
        else assert_true(overlap < 1e-12 * a);
        lab_free(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rounding_does_not_change_forces),
                                       cmocka_unit_test(a_rounding_has_no_stiffness)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
