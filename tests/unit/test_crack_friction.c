/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Friction of a closed crack against Coulomb's law over an even pressure. */
#include <math.h>
#include "support/exact_friction.h"
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "bond/bond.h"
#include "bond/crack_friction.h"

static const fl_vec3 ZERO = {0, 0, 0};
#define HALF_A 0.2
#define HALF_B 0.3
#define MU 0.3
#define OVERLAP 1e-5 /* [m]; the springs then reach the limit after 8 um */

typedef struct {
    fl_bodies b;
    fl_bond c;
} cracked;

/* Two bodies without shape, 1 m apart along x, with a face of 0.4 by 0.6 m between them that has failed. */
static void make_cracked(cracked *t)
{
    fl_err err = {0};
    *t = (cracked){0};
    assert_int_equal(fl_bodies_alloc(&t->b, 2, 2, &err), 0);
    for (int k = 0; k < 2; k++) {
        t->b.x[k] = v3(k, 0, 0);
        t->b.q[k] = q_one();
        t->b.m[k] = 900, t->b.invm[k] = 1.0 / 900, fl_body_set_inertia(&t->b, k, v3(100, 120, 150));
        fl_body_update_spin(&t->b, k);
    }
    t->c = (fl_bond){.i = 0,
                     .j = 1,
                     .area = 4.0 * HALF_A * HALF_B,
                     .length = 1,
                     .kn = 1e9,
                     .ks = 4e8,
                     .tensile_strength = 1e6,
                     .cohesion = 8e5,
                     .friction = MU,
                     .mixed_mode_exponent = 2,
                     .state = FL_BOND_BROKEN,
                     .h0 = 1.0};
    fl_bond_set_face(&t->c, &t->b, ZERO, v3(0.5, 0, 0), v3(1, 0, 0), v3(0, HALF_A, 0), v3(0, 0, HALF_B));
    for (int k = 0; k < FL_BOND_POINTS; k++) t->c.point[k].d = 1.0;
    fl_bond_update_separation(&t->c, &t->b, ZERO);
}

static void move_second(cracked *t, fl_vec3 u, fl_vec3 turn)
{
    const double a = v3_norm(turn);
    t->b.x[1] = v3_add(t->b.x[1], u);
    if (a > 0.0) {
        const fl_vec3 e = v3_scale(sin(0.5 * a) / a, turn);
        t->b.q[1] = q_mul((fl_quat){cos(0.5 * a), e.x, e.y, e.z}, t->b.q[1]);
    }
    fl_body_update_spin(&t->b, 1);
}

/* Steady motion in all ratios of slip and spin.  The law is within 5 % of Coulomb over this 3 by 2 face
 * (LAW_ERROR, the table of law/tangent.h: square 2.3, 3 by 1 5.4), and the crack is the law to the turn of
 * the face in the test, 0.1 mrad, and the wear, 0.1 %. */
static void steady_motion_is_that_of_the_law(void **state)
{
    (void)state;
    const fl_vec3 corner[4] = {
        {-HALF_A, -HALF_B, 0}, {HALF_A, -HALF_B, 0}, {HALF_A, HALF_B, 0}, {-HALF_A, HALF_B, 0}};
    const double LAW_ERROR = 0.05, CRACK_ERROR = 2e-3, rho = sqrt((HALF_A * HALF_A + HALF_B * HALF_B) / 3.0),
                 most = polygon_mean_distance(4, corner);
    for (int n = 0; n <= 24; n++) {
        const double angle = 0.5 * PI * (n % 5) / 4.0, way = 2.0 * PI * n / 25.0,
                     spin = n < 20 ? sin(angle) : -0.5, slide = n < 20 ? cos(angle) : 1.0;
        const fl_vec3 v = v3(1e-6 * slide * cos(way), 1e-6 * slide * sin(way), 0);
        const double w = 1e-6 * spin / rho;
        cracked t;
        make_cracked(&t);
        move_second(&t, v3(-OVERLAP, 0, 0), ZERO);
        for (int k = 0; k < 120; k++) {
            move_second(&t, v3(0, v.x, v.y), v3(w, 0, 0));
            assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 0);
        }
        const double L = -MU * t.c.force.x;
        /* about the centre of the face, which body 0 has on its x axis; the face of the test lies in y and z
         * */
        const flat_wrench got = {t.c.force.y / L, t.c.force.z / L, t.c.torque_i.x / L};
        fl_vec3 centre;
        const flat_wrench law = law_friction(polygon_second_moments(4, corner, &centre), v, w),
                          exact = exact_polygon_friction(4, corner, v, w);
        assert_near_of(hypot(got.x - law.x, got.y - law.y), 0, CRACK_ERROR, 1.0);
        assert_near_of(got.m - law.m, 0, CRACK_ERROR, most);
        assert_near_of(hypot(got.x - exact.x, got.y - exact.y), 0, LAW_ERROR, 1.0);
        assert_near_of(got.m - exact.m, 0, LAW_ERROR, most);
        fl_bodies_free(&t.b);
    }
}

/* On random paths, with the face pressed unevenly and from before it fails: the work of the pair less the
 * change of what the springs store is never taken back, and force and moments cancel. */
static void friction_takes_energy(void **state)
{
    (void)state;
    const double load = MU * 1e9 * OVERLAP * 4.0 * HALF_A * HALF_B,
                 full = 0.5 * load * load / (4e8 * 4.0 * HALF_A * HALF_B);
    int cracks = 0;
    for (int n = 0; n < 60; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        cracked t;
        make_cracked(&t);
        if (n % 2) { /* it fails on the way */
            t.c.state = FL_BOND_INTACT;
            t.c.h0 = 0.0;
            t.c.cohesion = 2e3;
            t.c.fracture_energy[0] = t.c.fracture_energy[1] = 0.05;
            for (int k = 0; k < FL_BOND_POINTS; k++) t.c.point[k] = (fl_bond_point){0};
        }
        move_second(&t, v3(-OVERLAP, 0, 0), v3(0, fl_rng_in(&g, -2e-5, 2e-5), fl_rng_in(&g, -2e-5, 2e-5)));
        fl_bond_force(&t.c, &t.b, ZERO);
        double taken = 0.0, given = t.c.given_to_friction, store = t.c.friction_spring_energy;
        fl_vec3 u = ZERO;
        double turn = 0.0;
        for (int k = 0; k < 2000; k++) {
            const fl_vec3 f0 = t.c.force_friction, tj0 = t.c.torque_j_friction;
            if (k % 150 == 0) {
                u = v3(0, fl_rng_in(&g, -4e-7, 4e-7), fl_rng_in(&g, -4e-7, 4e-7));
                turn = fl_rng_in(&g, -2e-6, 2e-6);
            }
            move_second(&t, u, v3(turn, 0, 0));
            assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 0);
            const double work =
                0.5 * (v3_dot(v3_add(f0, t.c.force_friction), u) - turn * (tj0.x + t.c.torque_j_friction.x));
            const double held = t.c.friction_spring_energy - store, passed = t.c.given_to_friction - given;
            taken += work + passed - held;
            /* The trapezoidal rule is of order 2 in the step, a 20th of the way to the limit: 1 % of what the
             * springs hold there. */
            assert_true(taken >= -0.01 * full);
            store = t.c.friction_spring_energy;
            given = t.c.given_to_friction;
            const fl_vec3 moment = v3_add(v3_add(t.c.torque_i_friction, t.c.torque_j_friction),
                                          v3_cross(v3_sub(t.b.x[0], t.b.x[1]), t.c.force_friction));
            assert_near_of(v3_norm(moment), 0, 1e-12,
                           v3_norm(t.c.torque_i_friction) + v3_norm(t.c.force_friction));
        }
        cracks += t.c.state == FL_BOND_BROKEN;
        assert_true(taken > 0.0);
        fl_bodies_free(&t.b);
    }
    assert_int_equal(cracks, 60);
}

/* A face that is not pressed stores nothing and begins anew. */
static void an_open_crack_has_no_friction(void **state)
{
    (void)state;
    const fl_crack_face face = {HALF_A, HALF_B, 4e8, MU};
    const fl_crack_pressure open = {0};
    const fl_face_separation a = {{0}, {0}, {0}}, b = {{0, 1e-6, 0}, {0}, {0}};
    fl_crack_springs s = {5, 6, 7, 1e8, 1e7, 8};
    const fl_crack_wrench w = fl_crack_friction_step(&s, &face, &open, &a, &b);
    assert_near(v3_norm(w.force), 0, 0);
    assert_near(w.couple, 0, 0);
    assert_near(s.y * s.y + s.z * s.z + s.moment * s.moment + s.k + s.energy, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(steady_motion_is_that_of_the_law),
        cmocka_unit_test(friction_takes_energy),
        cmocka_unit_test(an_open_crack_has_no_friction),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
