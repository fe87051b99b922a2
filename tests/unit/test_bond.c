/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "body/integrate.h"
#include "bond/bond_batch.h"
#include "bond/common_face.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* Two bodies without shape, 1 m apart along x, with a face of 0.4 by 0.6 m between them; E = 1 GPa, G = 0.4
 * GPa. */
typedef struct {
    fl_bodies b;
    fl_bond c;
} two;

static void make_two_bodies(two *t)
{
    fl_err err = {0};
    *t = (two){0};
    assert_int_equal(fl_bodies_alloc(&t->b, 2, 2, &err), 0);
    for (int k = 0; k < 2; k++) {
        t->b.x[k] = v3(k, 0, 0);
        t->b.q[k] = (fl_quat){1, 0, 0, 0};
        t->b.m[k] = 900, t->b.invm[k] = 1.0 / 900, fl_body_set_inertia(&t->b, k, v3(100, 120, 150));
        fl_body_update_spin(&t->b, k);
    }
    t->c = (fl_bond){.i = 0,
                     .j = 1,
                     .area = 0.24,
                     .length = 1,
                     .kn = 1e9,
                     .ks = 4e8,
                     .tensile_strength = 1e6,
                     .cohesion = 8e5,
                     .friction = 0.3,
                     .mixed_mode_exponent = 2};
    fl_bond_set_face(&t->c, &t->b, ZERO, v3(0.5, 0, 0), v3(1, 0, 0), v3(0, 0.2, 0), v3(0, 0, 0.3));
}

static void free_two_bodies(two *t) { fl_bodies_free(&t->b); }

static fl_vec3 random_vector(fl_rng *g, double size)
{
    return v3(fl_rng_in(g, -size, size), fl_rng_in(g, -size, size), fl_rng_in(g, -size, size));
}

/* Rotates body k by the small vector v and moves it by u. */
static void move_body(two *t, int k, fl_vec3 u, fl_vec3 v)
{
    const double a = v3_norm(v);
    t->b.x[k] = v3_add(t->b.x[k], u);
    if (a > 0.0) {
        const fl_vec3 e = v3_scale(sin(0.5 * a) / a, v);
        t->b.q[k] = q_mul((fl_quat){cos(0.5 * a), e.x, e.y, e.z}, t->b.q[k]);
    }
    fl_body_update_spin(&t->b, k);
}

/* A random state of damage without slip: the energy is then a function of the poses. */
static void damage_points(two *t, fl_rng *g)
{
    for (int k = 0; k < FL_BOND_POINTS; k++) {
        t->c.point[k].d = fl_rng_in(g, 0, 1);
        t->c.point[k].lambda_c = 1e9, t->c.point[k].lambda_f = 2e9; /* so that damage does not grow */
    }
    t->c.friction = 0.0;
}

/* Force and torques are the gradient of the energy, for separations and rotations of all sizes. */
static void force_is_the_gradient(void **state)
{
    (void)state;
    for (int n = 0; n < 200; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        const double size = n % 2 ? 1e-3 : 0.3, h = 1e-4 * size;
        two t;
        make_two_bodies(&t);
        damage_points(&t, &g);
        t.c.tensile_strength = t.c.cohesion = INFINITY;
        for (int k = 0; k < 2; k++) move_body(&t, k, random_vector(&g, size), random_vector(&g, size));
        fl_bond_force(&t.c, &t.b, ZERO);
        const fl_vec3 f = t.c.force, ti = t.c.torque_i, tj = t.c.torque_j, u = random_vector(&g, 1),
                      v = random_vector(&g, 1);
        const double store = t.c.elastic_energy, scale = v3_norm(f) + v3_norm(ti) + v3_norm(tj);
        for (int k = 0; k < 2; k++) {
            double W[2];
            for (int e = 0; e < 2; e++) {
                two s = t;
                fl_err err = {0};
                assert_int_equal(fl_bodies_alloc(&s.b, 2, 2, &err), 0);
                for (int l = 0; l < 2; l++) {
                    s.b.x[l] = t.b.x[l], s.b.q[l] = t.b.q[l], s.b.I[l] = t.b.I[l], s.b.invI[l] = t.b.invI[l];
                    move_body(&s, l, ZERO, ZERO);
                }
                const double way = e ? h : -h;
                move_body(&s, k, v3_scale(way, u), v3_scale(way, v));
                fl_bond_force(&s.c, &s.b, ZERO);
                W[e] = s.c.elastic_energy;
                free_two_bodies(&s);
            }
            const double power = k ? -v3_dot(f, u) + v3_dot(tj, v) : v3_dot(f, u) + v3_dot(ti, v);
            assert_near_of(-(W[1] - W[0]) / (2 * h), power, 1e-5, scale);
        }
        assert_true(store > 0.0);
        free_two_bodies(&t);
    }
}

/* The moments of the pair cancel about any point. A rigid motion of the pair causes no force, and rotates the
 * force with it. */
static void forces_of_the_pair_cancel(void **state)
{
    (void)state;
    for (int n = 0; n < 200; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        two t;
        make_two_bodies(&t);
        t.c.tensile_strength = 1e5; /* some points break, some slide */
        t.c.fracture_energy[0] = 200, t.c.fracture_energy[1] = 300;
        t.c.damping = 1e-4;
        for (int k = 0; k < 2; k++) {
            move_body(&t, k, random_vector(&g, 2e-4), random_vector(&g, 2e-4));
            t.b.w[k] = random_vector(&g, 1), t.b.v[k] = random_vector(&g, 1);
        }
        fl_bond_force(&t.c, &t.b, ZERO);
        const fl_vec3 turn = random_vector(&g, 3),
                      sum = v3_add(v3_add(t.c.torque_i, t.c.torque_j),
                                   v3_cross(v3_sub(t.b.x[0], t.b.x[1]), t.c.force));
        assert_near_of(v3_norm(sum), 0, 1e-13, v3_norm(t.c.force) + v3_norm(t.c.torque_i));
        /* the same state after a rigid motion has the rotated force */
        fl_bond was = t.c;
        const fl_quat q = q_unit((fl_quat){1, turn.x, turn.y, turn.z});
        for (int k = 0; k < 2; k++) {
            t.b.x[k] = v3_add(q_rotate(q, t.b.x[k]), v3(3, -7, 2));
            t.b.v[k] = q_rotate(q, t.b.v[k]);
            t.b.q[k] = q_mul(q, t.b.q[k]);
            t.b.L[k] = ZERO;
            const fl_vec3 w = q_rotate(q, t.b.w[k]);
            fl_body_update_spin(&t.b, k);
            t.b.w[k] = w;
        }
        fl_bond_force(&t.c, &t.b, ZERO);
        assert_near_of(v3_norm(v3_sub(t.c.force, q_rotate(q, was.force))), 0, 1e-9, v3_norm(was.force));
        assert_near_of(v3_norm(v3_sub(t.c.torque_i, q_rotate(q, was.torque_i))), 0, 1e-9,
                       v3_norm(was.torque_i));
        free_two_bodies(&t);
        make_two_bodies(&t);
        for (int k = 0; k < 2; k++) {
            t.b.x[k] = v3_add(q_rotate(q, t.b.x[k]), v3(3, -7, 2));
            t.b.q[k] = q;
            fl_body_update_spin(&t.b, k);
        }
        fl_bond_force(&t.c, &t.b, ZERO);
        assert_near_of(v3_norm(t.c.force), 0, 1e-14, t.c.kn * t.c.area * 10.0);
        free_two_bodies(&t);
    }
}

/* For small motions the stiffnesses are E A/l, G A/l, E I/l and G (Iy + Iz)/l, those of a bar of the face's
 * section. */
static void springs_are_those_of_the_section(void **state)
{
    (void)state;
    const double h = 1e-7, A = 0.24, Iy = 0.4 * 0.6 * 0.6 * 0.6 / 12, Iz = 0.6 * 0.4 * 0.4 * 0.4 / 12;
    static const fl_vec3 U[2] = {{1, 0, 0}, {0, 1, 0}};
    const double expected[2] = {1e9 * A, 4e8 * A};
    for (int k = 0; k < 2; k++) {
        two t;
        make_two_bodies(&t);
        move_body(&t, 1, v3_scale(h, U[k]), ZERO);
        fl_bond_force(&t.c, &t.b, ZERO);
        assert_near(v3_dot(t.c.force, U[k]) / h, expected[k], 1e-8);
        free_two_bodies(&t);
    }
    static const fl_vec3 V[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const double moment[3] = {4e8 * (Iy + Iz), 1e9 * Iy, 1e9 * Iz};
    for (int k = 0; k < 3; k++) {
        two t;
        make_two_bodies(&t);
        const fl_vec3 v = v3_scale(h, V[k]);
        /* about the centre of the face, half by each body */
        move_body(&t, 1, v3_cross(v3_scale(0.5, v), v3(0.5, 0, 0)), v3_scale(0.5, v));
        move_body(&t, 0, v3_cross(v3_scale(-0.5, v), v3(-0.5, 0, 0)), v3_scale(-0.5, v));
        fl_bond_force(&t.c, &t.b, ZERO);
        assert_near(v3_dot(t.c.torque_i, V[k]) / h, moment[k], 1e-6);
        assert_near(v3_dot(t.c.torque_j, V[k]) / h, -moment[k], 1e-6);
        free_two_bodies(&t);
    }
}

/* A face far from its strength is summed in closed form, one close to it point by point. Both give the
 * same. */
static void whole_face_sums_equal_point_sums(void **state)
{
    (void)state;
    for (int n = 0; n < 100; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        two t;
        fl_bond near;
        make_two_bodies(&t);
        t.c.friction = 1.0;
        for (int k = 0; k < 2; k++) move_body(&t, k, random_vector(&g, 1e-3), random_vector(&g, 1e-3));
        t.c.tensile_strength = t.c.cohesion = INFINITY;
        near = t.c;
        fl_bond_force(&t.c, &t.b, ZERO);
        /* the point of largest opening is hardly ever that of largest shear, and it is not compressed */
        double lo = 1e3, hi = 1e9;
        for (int k = 0; k < 60; k++) {
            fl_bond c = near;
            c.tensile_strength = c.cohesion = sqrt(lo * hi);
            fl_bond_force(&c, &t.b, ZERO);
            if (c.state == FL_BOND_INTACT) hi = c.tensile_strength;
            else lo = c.tensile_strength;
        }
        near.tensile_strength = near.cohesion = hi;
        fl_bond_force(&near, &t.b, ZERO);
        assert_int_equal(near.state, FL_BOND_INTACT);
        assert_near_of(v3_norm(v3_sub(near.force, t.c.force)), 0, 1e-13, t.c.kn * t.c.area * 1e-3);
        assert_near_of(v3_norm(v3_sub(near.torque_i, t.c.torque_i)), 0, 1e-13, t.c.kn * t.c.area * 1e-3);
        assert_near_of(v3_norm(v3_sub(near.torque_j, t.c.torque_j)), 0, 1e-13, t.c.kn * t.c.area * 1e-3);
        assert_near(near.elastic_energy, t.c.elastic_energy, 1e-13);
        free_two_bodies(&t);
    }
}

/* A compressed face is sheared until every point has failed: the normal force stays, the shear force falls to
 * friction. Then the face opens, and the bond ends without a force. */
static void a_closed_crack_still_carries_pressure(void **state)
{
    (void)state;
    two t;
    make_two_bodies(&t);
    t.c.fracture_energy[0] = t.c.fracture_energy[1] = 2000;
    move_body(&t, 1, v3(-1e-3, 0, 0), ZERO);
    fl_bond_force(&t.c, &t.b, ZERO);
    const double N = -t.c.force.x;
    assert_near(N, 1e9 * 1e-3 * 0.24, 1e-12);
    int broken = 0;
    double before = 0.0, slid = 0.0;
    for (int k = 0; k < 20000; k++) {
        move_body(&t, 1, v3(0, 1e-6, 0), ZERO);
        assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 0);
        if (!broken && t.c.state == FL_BOND_BROKEN) {
            broken = 1;
            before = t.c.force.x;
            slid = 1e-6 * (k + 1);
            assert_near(t.c.force.x, -N, 1e-12);
            assert_near(t.c.force.y, 0.3 * N, 1e-12);
        }
    }
    assert_true(broken);
    /* the force falls with the part of the face that is still opposite its partner */
    assert_near(t.c.force.x, before * (0.4 - 0.02) / (0.4 - slid), 1e-9);
    const double store = t.c.elastic_energy;
    assert_true(store > 0.0);
    move_body(&t, 1, v3(1e-3 + 1e-9, 0, 0), ZERO);
    assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 1);
    assert_int_equal(t.c.state, FL_BOND_ENDED);
    assert_near(v3_norm(t.c.force), 0, 0);
    assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 0);
    free_two_bodies(&t);
}

/* Dissipated energy is the work done less the stored energy, on a random path of steps. */
static void energies_balance(void **state)
{
    (void)state;
    for (int n = 0; n < 50; n++) {
        fl_rng g = fl_rng_of(test_seed(), n, FL_RNG_TEST);
        two t;
        make_two_bodies(&t);
        t.c.fracture_energy[0] = n % 3 ? 600 : 0, t.c.fracture_energy[1] = n % 3 ? 900 : 0;
        t.c.friction = n % 2 ? 0.3 : 0.0;
        double work = 0.0, largest = 0.0;
        fl_bond_force(&t.c, &t.b, ZERO);
        fl_vec3 u = v3_scale(2e-6, v3_unit(random_vector(&g, 1)));
        u.x = fabs(
            u.x); /* the face opens: on a path that closes it, the trapezoidal rule is inexact at the kink */
        for (int k = 0; k < 20000; k++) {
            const fl_vec3 f0 = t.c.force;
            move_body(&t, 1, u, ZERO);
            const int ended = fl_bond_force(&t.c, &t.b, ZERO);
            work += 0.5 * v3_dot(v3_add(f0, t.c.force), u);
            largest = fmax(largest, work);
            if (ended) break;
        }
        assert_int_equal(t.c.state, FL_BOND_ENDED);
        /* friction does no work while the face is open; shear in one direction follows straight lines */
        assert_near_of(work,
                       t.c.elastic_energy + t.c.friction_spring_energy + t.c.dissipated +
                           t.c.given_to_friction - t.c.friction_spring_energy,
                       1e-9, largest);
        if (t.c.fracture_energy[0] > 0.0) {
            const double share =
                t.c.ks * (u.y * u.y + u.z * u.z) / (t.c.kn * u.x * u.x + t.c.ks * (u.y * u.y + u.z * u.z));
            assert_near(t.c.dissipated / t.c.area, 600 + 300 * share * share, 1e-4);
        }
        free_two_bodies(&t);
    }
}

/* Strength, fracture energy and limit separation in mode I. */
static void invalid_sizes_are_reported(void **state)
{
    (void)state;
    two t;
    make_two_bodies(&t);
    assert_near(fl_bond_max_length(1e9, 10, 0.7e6), 0.040816, 1e-4);
    assert_near(fl_bond_fracture_energy(&t.c), 500, 1e-12); /* brittle: the stored energy only */
    t.c.fracture_energy[0] = 600;
    assert_near(fl_bond_fracture_energy(&t.c), 600, 1e-12);
    t.c.fracture_energy[0] = 10;
    assert_near(fl_bond_fracture_energy(&t.c), 500, 1e-12);
    t.c.min_ductility = 1.5;
    assert_near(fl_bond_fracture_energy(&t.c), 750, 1e-12);
    t.c.point[4].d = 0.5;
    assert_near(fl_bond_mean_damage(&t.c), 0.5 * 16.0 / 36.0, 1e-14);
    /* rotated by more than a right angle the faces no longer face each other */
    move_body(&t, 1, ZERO, v3(0, 0, 0.6 * PI));
    assert_int_equal(fl_bond_force(&t.c, &t.b, ZERO), 1);
    assert_int_equal(t.c.state, FL_BOND_ENDED);
    free_two_bodies(&t);
}

/* Two boxes side by side, one lower and shifted: the common rectangle. Then pairs without a common face. */
static void common_faces_are_found(void **state)
{
    (void)state;
    fl_poly p = {0}, q = {0};
    fl_err err = {0};
    fl_common_face s;
    const fl_mat3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    assert_int_equal(fl_poly_box(&p, v3(1, 2, 0.5), &err), 0);
    assert_int_equal(fl_poly_box(&q, v3(1, 2, 0.5), &err), 0);
    fl_poly_to_frame(&q, v3(-2, -1, -0.2), one);
    assert_int_equal(fl_common_face_find(&p, &q, ZERO, v3(1, 0, 0), &s, &err), 1);
    assert_near(s.area, 3 * 0.8, 1e-14);
    assert_near_of(v3_norm(v3_sub(s.x, v3(1, 0.5, 0.1))), 0, 1e-14, 1);
    assert_near_of(v3_norm(v3_sub(s.n, v3(1, 0, 0))), 0, 1e-14, 1);
    assert_near(v3_norm(s.a), 0.4, 1e-13);
    assert_near(v3_norm(s.b), 1.5, 1e-13);
    assert_near(fabs(s.a.z), 0.4, 1e-13);
    assert_near(fabs(s.b.y), 1.5, 1e-13);
    /* one periodic cell apart */
    assert_int_equal(fl_common_face_find(&p, &q, v3(10, 0, 0), v3(1, 0, 0), &s, &err), 0);
    assert_int_equal(fl_common_face_find(&p, &q, v3(0, 0, 0.9), v3(1, 0, 0), &s, &err),
                     0); /* an edge, no face */
    assert_int_equal(fl_common_face_find(&p, &q, v3(0.1, 0, 0), v3(1, 0, 0), &s, &err), 0);
    fl_poly_free(&p);
    fl_poly_free(&q);
    fl_common_face_disc(PI, v3(1, 2, 3), v3(0, 0, 1), &s);
    assert_near(PI * v3_norm2(s.a) / 3.0, PI / 4.0, 1e-14); /* A h^2/3 = pi r^4/4 */
}

/* A bond evaluated in a batch has the bits of one evaluated alone, or the batch leaves it unchanged. It
 * leaves points that may have reached their strength, sides rotated by a right angle or half a turn, and
 * bonds of which only some have dashpots. */
static void a_batch_has_the_bits_of_single_bonds(void **state)
{
    (void)state;
    int in_batch = 0, single = 0;
    for (int way = 0; way < 60; way++) {
        fl_rng g = fl_rng_of(test_seed(), way, FL_RNG_TEST);
        const int n = 1 + way % FL_LANE_COUNT;
        two t[FL_LANE_COUNT];
        fl_bond one[FL_LANE_COUNT], all[FL_LANE_COUNT], *at[FL_LANE_COUNT];
        fl_vec3 off[FL_LANE_COUNT];
        uint8_t done[FL_LANE_COUNT];
        fl_bodies b = {0};
        fl_err err = {0};
        assert_int_equal(fl_bodies_alloc(&b, 2 * FL_LANE_COUNT, 2 * FL_LANE_COUNT, &err), 0);
        for (int k = 0; k < n; k++) {
            const double size = k % 4 == 3 ? 0.01 : 1e-4, rotation = k % 5 == 4 ? 2.0 : size;
            make_two_bodies(&t[k]);
            for (int e = 0; e < 2; e++)
                move_body(&t[k], e, random_vector(&g, size), random_vector(&g, rotation));
            if (way % 7 == 6 && k == 2) move_body(&t[k], 1, ZERO, v3(3.14159265358979, 0, 0));
            for (int e = 0; e < 2; e++) {
                b.x[2 * k + e] = t[k].b.x[e], b.q[2 * k + e] = t[k].b.q[e];
                b.v[2 * k + e] = random_vector(&g, 1), b.w[2 * k + e] = random_vector(&g, 1);
            }
            b.is_isotropic[2 * k] = k == 5;
            one[k] = t[k].c;
            one[k].i = 2 * k, one[k].j = 2 * k + 1;
            one[k].damping = way % 3 == 0 ? 0.0 : way % 3 == 1 || k % 2 ? 1e-3 : 0.0;
            if (k % 3 == 2) one[k].tensile_strength = INFINITY, one[k].cohesion = INFINITY;
            all[k] = one[k], at[k] = &all[k], off[k] = k % 2 ? random_vector(&g, 1e-5) : ZERO;
            free_two_bodies(&t[k]);
        }
        fl_bond_batch_force(at, off, n, &b, done);
        for (int k = 0; k < n; k++) {
            const fl_bond before = one[k];
            fl_bond_force(&one[k], &b, off[k]);
            assert_memory_equal(&all[k], done[k] ? &one[k] : &before, sizeof all[k]);
            in_batch += done[k], single += !done[k];
        }
        fl_bodies_free(&b);
    }
    assert_true(in_batch > 100 && single > 50);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(force_is_the_gradient),
        cmocka_unit_test(forces_of_the_pair_cancel),
        cmocka_unit_test(springs_are_those_of_the_section),
        cmocka_unit_test(whole_face_sums_equal_point_sums),
        cmocka_unit_test(a_closed_crack_still_carries_pressure),
        cmocka_unit_test(energies_balance),
        cmocka_unit_test(invalid_sizes_are_reported),
        cmocka_unit_test(common_faces_are_found),
        cmocka_unit_test(a_batch_has_the_bits_of_single_bonds),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
