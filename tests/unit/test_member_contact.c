/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "base/pi.h"
#include "base/rng.h"
#include "member/member_contact.h"

static fl_vec3 random_vector(fl_rng *g, double a)
{
    return v3(fl_rng_in(g, -a, a), fl_rng_in(g, -a, a), fl_rng_in(g, -a, a));
}

/* A contact of unequal stiffness and a strained state of it. */
struct state {
    fl_member_contact c;
    fl_vec3 xi, xj;
    fl_quat qi, qj;
};

static struct state random_state(fl_rng *g, int kind, double angle)
{
    struct state s;
    const fl_quat whole = q_unit(q_of_vector(random_vector(g, 2.0)));
    s.c = (fl_member_contact){.kind = kind,
                              .e0 = q_unit(q_of_vector(random_vector(g, 1.5))),
                              .length = 0.7,
                              .axial = 40.0,
                              .shear = {7.0, 3.0},
                              .turn = {2.0, 5.0, 1.5}};
    const fl_vec3 along = q_rotate(s.c.e0, v3(s.c.length, 0, 0));
    s.xi = random_vector(g, 1.0);
    s.xj = v3_add(s.xi, v3_add(q_rotate(whole, along), random_vector(g, 0.1)));
    s.qi = q_unit(q_mul(q_of_vector(random_vector(g, 0.5 * angle)), whole));
    s.qj = q_unit(q_mul(q_of_vector(random_vector(g, 0.5 * angle)), whole));
    return s;
}

static double energy_of(const struct state *s)
{
    double energy, r2;
    fl_member_contact_force(&s->c, v3_sub(s->xj, s->xi), s->qi, s->qj, &energy, &r2);
    return energy;
}

static fl_vec3 unit_vector(int k, double h) { return v3(k == 0 ? h : 0, k == 1 ? h : 0, k == 2 ? h : 0); }

/* -dE/ds of the four groups of freedoms by central differences of the fourth order. */
static fl_vec3 gradient(const struct state *s, int what)
{
    double out[3];
    for (int k = 0; k < 3; k++) {
        double e[4];
        static const double at[4] = {-2, -1, 1, 2};
        const double h = 1e-3;
        for (int n = 0; n < 4; n++) {
            struct state t = *s;
            const fl_vec3 d = unit_vector(k, at[n] * h);
            if (what == 0) t.xi = v3_add(t.xi, d);
            if (what == 1) t.xj = v3_add(t.xj, d);
            if (what == 2) t.qi = q_mul(q_of_vector(d), t.qi);
            if (what == 3) t.qj = q_mul(q_of_vector(d), t.qj);
            e[n] = energy_of(&t);
        }
        out[k] = -(e[0] - 8.0 * e[1] + 8.0 * e[2] - e[3]) / (12.0 * h);
    }
    return v3(out[0], out[1], out[2]);
}

static void assert_near(fl_vec3 a, fl_vec3 b, double tol) { assert_true(v3_norm(v3_sub(a, b)) <= tol); }

/* Differences of the fourth order with h = 1e-3: h4 times the fifth derivative, of some 100 here. */
static const double DIFFERENCE = 1e-8;

static void force_is_the_gradient_of_energy(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(1, 0, FL_RNG_TEST);
    static const double angles[] = {0.02, 0.2, 0.6, 1.0};
    for (int kind = FL_MEMBER_BEAM; kind <= FL_MEMBER_BAR; kind++)
        for (int n = 0; n < 40; n++) {
            struct state s = random_state(&g, kind, angles[n % 4]);
            double r2;
            const fl_member_force f =
                fl_member_contact_force(&s.c, v3_sub(s.xj, s.xi), s.qi, s.qj, NULL, &r2);
            assert_near(gradient(&s, 0), f.f, DIFFERENCE);
            assert_near(gradient(&s, 1), v3_neg(f.f), DIFFERENCE);
            assert_near(gradient(&s, 2), f.mi, DIFFERENCE);
            assert_near(gradient(&s, 3), f.mj, DIFFERENCE);
        }
}

/* The ends stand off the balls: forces and moments are still the gradient, and no momentum is made. */
static void arms_turn_with_their_balls(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(3, 0, FL_RNG_TEST);
    for (int n = 0; n < 80; n++) {
        struct state s = random_state(&g, n % 4, 0.4);
        double r2;
        s.c.arms = 1;
        for (int k = 0; k < 2; k++) s.c.arm[k] = random_vector(&g, 0.4);
        s.xi = v3_sub(s.xi, q_rotate(s.qi, s.c.arm[0]));
        s.xj = v3_sub(s.xj, q_rotate(s.qj, s.c.arm[1]));
        const fl_vec3 dx = v3_sub(s.xj, s.xi);
        const fl_member_force f = fl_member_contact_force(&s.c, dx, s.qi, s.qj, NULL, &r2);
        assert_near(gradient(&s, 0), f.f, DIFFERENCE);
        assert_near(gradient(&s, 1), v3_neg(f.f), DIFFERENCE);
        assert_near(gradient(&s, 2), f.mi, DIFFERENCE);
        assert_near(gradient(&s, 3), f.mj, DIFFERENCE);
        assert_near(v3_add(f.mi, f.mj), v3_cross(dx, f.f), 1e-13 * 40.0);
    }
}

static void momentum_balances(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(2, 0, FL_RNG_TEST);
    for (int n = 0; n < 60; n++) {
        struct state s = random_state(&g, n % 4, 0.8);
        const fl_vec3 dx = v3_sub(s.xj, s.xi);
        double r2;
        const fl_member_force f = fl_member_contact_force(&s.c, dx, s.qi, s.qj, NULL, &r2);
        assert_near(v3_add(f.mi, f.mj), v3_cross(dx, f.f), 1e-13 * 40.0);
    }
}

static void a_rotation_of_all_makes_no_force(void **state)
{
    (void)state;
    fl_rng g = fl_rng_of(3, 0, FL_RNG_TEST);
    for (int kind = 0; kind < 4; kind++)
        for (int turn = 0; turn <= 360; turn += 30) {
            struct state s = random_state(&g, kind, 0.0);
            const fl_quat q = q_of_vector(v3_scale(fl_radians(turn), v3_unit(v3(1, 2, 3))));
            const fl_vec3 dx = q_rotate(q, q_rotate(s.c.e0, v3(s.c.length, 0, 0)));
            double r2;
            const fl_member_force f = fl_member_contact_force(&s.c, dx, q, q, NULL, &r2);
            assert_true(v3_norm(f.f) < 1e-13 * 40.0 && v3_norm(f.mi) < 1e-13 * 40.0 &&
                        v3_norm(f.mj) < 1e-13 * 40.0);
        }
}

/* Small sway of the hinge against a clamped ball: 3 EI/L3. */
static void a_hinged_piece_has_three_ei_over_l3(void **state)
{
    (void)state;
    const double l = 0.5, ei = 3.0;
    const fl_member_contact c = {.kind = FL_MEMBER_HINGE_J,
                                 .e0 = q_one(),
                                 .length = l,
                                 .axial = 100.0,
                                 .shear = {3 * ei / l, 3 * ei / l}};
    double r2;
    const fl_member_force f = fl_member_contact_force(&c, v3(l, 1e-6, 0), q_one(), q_one(), NULL, &r2);
    assert_true(fabs(f.f.y / (1e-6 * 3.0 * ei / (l * l * l)) - 1.0) < 1e-5);
    assert_true(fabs(f.mi.z / (1e-6 * 3.0 * ei / (l * l)) - 1.0) < 1e-5);
}

/* Against asin of the C library, from below to beyond the limit of rotation. */
static void arcsine_is_that_of_the_library(void **state)
{
    (void)state;
    for (double s = 1e-4; s < 0.9999; s += 1e-3)
        assert_true(fabs((1.0 + fl_member_arcsine(s * s) * s * s) * s / asin(s) - 1.0) < 1e-14);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(force_is_the_gradient_of_energy),
                                       cmocka_unit_test(arms_turn_with_their_balls),
                                       cmocka_unit_test(momentum_balances),
                                       cmocka_unit_test(a_rotation_of_all_makes_no_force),
                                       cmocka_unit_test(a_hinged_piece_has_three_ei_over_l3),
                                       cmocka_unit_test(arcsine_is_that_of_the_library)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
