/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "sim/energy_balance.h"
#include "support/near.h"
#include "base/pi.h"
#include "base/rng.h"
#include "body/body_batch.h"
#include "body/integrate.h"
#include "support/small_world.h"
#include "support/shapes.h"

#define TURNS (FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ)

static fl_vec3 random_vector(fl_rng *g)
{
    fl_vec3 a;
    a.x = fl_rng_normal(g);
    a.y = fl_rng_normal(g);
    a.z = fl_rng_normal(g);
    return a;
}

/* One body of mass 2 and moments I, in random orientation and motion; fixed rotations at rest. */
static void random_body(fl_bodies *b, fl_rng *g, fl_vec3 I, unsigned fixed)
{
    fl_err err = {0};
    assert_int_equal(fl_bodies_alloc(b, 1, 1, &err), 0);
    b->m[0] = 2.0;
    b->invm[0] = 0.5;
    fl_body_set_inertia(b, 0, I);
    b->bounding_radius[0] = 1.0;
    b->q[0] = shape_rotation(g);
    b->fixed_dof[0] = (uint8_t)fixed;
    b->v[0] = random_vector(g);
    fl_vec3 w = random_vector(g);
    if (fixed & FL_DOF_RX) w.x = 0.0;
    if (fixed & FL_DOF_RY) w.y = 0.0;
    if (fixed & FL_DOF_RZ) w.z = 0.0;
    fl_body_update_spin(b, 0);
    fl_body_set_spin(b, 0, w);
}

static double distance_between(fl_vec3 a, fl_vec3 b) { return v3_norm(v3_sub(a, b)); }

static double rotation_between(fl_quat a, fl_quat b)
{
    const fl_quat d = q_mul(q_conj(a), b);
    return 2.0 * sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
}

static void a_kick_changes_only_momenta(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 1, FL_RNG_TEST);
    fl_bodies b;
    (void)state;
    random_body(&b, &g, v3(1, 2, 3), 0);
    const fl_vec3 x = b.x[0], v = b.v[0], L = b.L[0], f = b.f[0] = random_vector(&g),
                  t = b.t[0] = random_vector(&g);
    const fl_quat q = b.q[0];
    fl_kick(&b, 0, 0.3);
    assert_near_of(distance_between(b.v[0], v3_madd(v, 0.3 / 2.0, f)), 0.0, 1e-15, 1.0);
    assert_near_of(distance_between(b.L[0], v3_madd(L, 0.3, t)), 0.0, 1e-15, 1.0);
    assert_memory_equal(&b.x[0], &x, sizeof x);
    assert_memory_equal(&b.q[0], &q, sizeof q);
    const fl_vec3 s = m3_tmul(fl_body_axes(&b, 0), b.L[0]);
    assert_near_of(distance_between(b.w[0], m3_mul(fl_body_axes(&b, 0), v3(s.x, s.y / 2.0, s.z / 3.0))), 0.0,
                   1e-14, 1.0);
    fl_bodies_free(&b);
}

/* Moments (I, I, J) or (J, I, I) are rotated exactly: about L by |L|/I t, then about the axis by (1/J - 1/I)
 * L_axis t. */
static void a_symmetric_top_turns_exactly(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 2, FL_RNG_TEST);
    (void)state;
    for (int c = 0; c < 60; c++) {
        const double few = fl_rng_in(&g, 0.2, 1.0), more = fl_rng_in(&g, 1.0, 1.9),
                     dt = fl_rng_in(&g, 0.0, 0.5);
        const int axis = c % 3 == 2 ? 0 : 2; /* index of the distinct moment; a sphere for c % 3 == 0 */
        const fl_vec3 I = c % 3 == 0  ? v3(more, more, more)
                          : axis == 0 ? v3(few, more, more)
                                      : v3(1, 1, more);
        const double mid = I.y, other = axis == 0 ? I.x : I.z;
        fl_bodies b;
        random_body(&b, &g, I, 0);
        const fl_quat q = b.q[0];
        const fl_vec3 L = b.L[0];
        const double along = v3_dot(m3_col(fl_body_axes(&b, 0), axis), L);
        const fl_quat expected = q_mul(q_of_vector(v3_scale(dt / mid, L)),
                                       q_mul(q, q_about_axis(axis, dt * (1.0 / other - 1.0 / mid) * along)));
        fl_drift(&b, 0, dt);
        assert_near_of(rotation_between(b.q[0], expected), 0.0, 1e-14, 1.0);
        assert_memory_equal(&b.L[0], &L, sizeof L);
        fl_bodies_free(&b);
    }
}

static void a_drift_is_reversible(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 3, FL_RNG_TEST);
    (void)state;
    for (int c = 0; c < 50; c++) {
        fl_bodies b;
        random_body(&b, &g, v3(1, 1.5, 2.2), 0);
        const fl_quat q = b.q[0];
        const fl_vec3 x = b.x[0];
        for (int k = 0; k < 100; k++) fl_drift(&b, 0, 0.05);
        for (int k = 0; k < 100; k++) fl_drift(&b, 0, -0.05);
        assert_near_of(rotation_between(b.q[0], q), 0.0, 1e-12, 1.0);
        assert_near_of(distance_between(b.x[0], x), 0.0, 1e-13, 5.0);
        const fl_quat n = b.q[0];
        assert_near(n.w * n.w + n.x * n.x + n.y * n.y + n.z * n.z, 1.0, 1e-15);
        fl_bodies_free(&b);
    }
}

/* No point of the core moves farther in a step than the travel counter says. */
static void the_travel_counter_is_an_upper_bound(void **state)
{
    (void)state;
    for (unsigned fixed = 0; fixed < 64; fixed += 4) {
        fl_rng g = fl_rng_of(test_seed(), 200 + fixed, FL_RNG_TEST);
        fl_bodies b;
        random_body(&b, &g, v3(1, 1.5, 2.2), fixed);
        double worst = 0.0;
        for (int k = 0; k < 1000; k++) {
            const fl_vec3 x = b.x[0];
            const fl_mat3 R = fl_body_axes(&b, 0);
            const double before = b.odometer[0];
            fl_drift(&b, 0, 0.1);
            for (int p = 0; p < 20; p++) {
                const fl_vec3 a = shape_direction(&g); /* bound = 1 */
                const double path =
                    distance_between(v3_add(x, m3_mul(R, a)), v3_add(b.x[0], m3_mul(fl_body_axes(&b, 0), a)));
                worst = fmax(worst, path / (b.odometer[0] - before));
            }
        }
        assert_true(worst <= 1.0 + 1e-12);
        assert_true(worst > 0.5);
        fl_bodies_free(&b);
    }
}

/* For any forces and every set of fixed directions, fixed components keep their bits and free ones move. */
static void fixed_directions_stay(void **state)
{
    (void)state;
    for (unsigned fixed = 0; fixed < 64; fixed++) {
        fl_rng g = fl_rng_of(test_seed(), fixed, FL_RNG_TEST);
        fl_bodies b;
        random_body(&b, &g, v3(1, 1.5, 2.2), fixed);
        const fl_vec3 v = b.v[0], w = b.w[0];
        for (int k = 0; k < 500; k++) {
            b.f[0] = random_vector(&g);
            b.t[0] = random_vector(&g);
            fl_kick(&b, 0, 0.01);
            fl_drift(&b, 0, 0.02);
            fl_kick(&b, 0, 0.01);
        }
        assert_int_equal(b.v[0].x == v.x, (fixed & FL_DOF_X) != 0);
        assert_int_equal(b.v[0].y == v.y, (fixed & FL_DOF_Y) != 0);
        assert_int_equal(b.v[0].z == v.z, (fixed & FL_DOF_Z) != 0);
        assert_int_equal(b.w[0].x == w.x, (fixed & FL_DOF_RX) != 0);
        assert_int_equal(b.w[0].y == w.y, (fixed & FL_DOF_RY) != 0);
        assert_int_equal(b.w[0].z == w.z, (fixed & FL_DOF_RZ) != 0);
        const fl_vec3 s = m3_tmul(fl_body_axes(&b, 0), b.L[0]);
        assert_near_of(distance_between(m3_mul(fl_body_axes(&b, 0), v3(s.x, s.y / 1.5, s.z / 2.2)), b.w[0]),
                       0.0, 1e-13, v3_norm(b.w[0]));
        fl_bodies_free(&b);
    }
}

/* Fixed about x and y, a body without torque rotates about z at one speed for ever, in every orientation of
 * its axes. */
static void two_fixed_rotations_leave_an_axle(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 4, FL_RNG_TEST);
    (void)state;
    for (int c = 0; c < 20; c++) {
        fl_bodies b;
        random_body(&b, &g, v3(1, 1.5, 2.2), FL_DOF_RX | FL_DOF_RY);
        const double w = b.w[0].z, dt = 0.01;
        const int steps = 5000;
        const fl_quat q = b.q[0];
        for (int k = 0; k < steps; k++) {
            fl_kick(&b, 0, 0.5 * dt);
            fl_drift(&b, 0, dt);
            fl_kick(&b, 0, 0.5 * dt);
        }
        assert_near(b.w[0].z, w, 1e-11);
        assert_near_of(
            rotation_between(b.q[0], q_mul(q_of_vector(v3(0, 0, fmod(w * dt * steps, 2.0 * PI))), q)), 0.0,
            1e-9, 1.0);
        assert_near_of(b.work_of_constraints[0], 0.0, 1e-15, 1.0); /* a constraint at rest does no work */
        fl_bodies_free(&b);
    }
}

/* One fixed rotation: L keeps its free components, and the energy error is of the second order in the
 * step. */
static void one_fixed_rotation_conserves_energy(void **state)
{
    (void)state;
    for (int c = 0; c < 10; c++) {
        double error[2];
        for (int d = 0; d < 2; d++) {
            fl_rng g = fl_rng_of(test_seed(), 100 + c, FL_RNG_TEST);
            fl_bodies b;
            random_body(&b, &g, v3(1, 1.5, 2.2), FL_DOF_RY);
            const fl_vec3 L = b.L[0];
            const double E = fl_body_kinetic_energy(&b, 0), dt = 0.02 / (1 << d);
            for (int k = 0; k < 100 << d; k++) fl_drift(&b, 0, dt);
            assert_near_of(b.L[0].x, L.x, 1e-13, v3_norm(L));
            assert_near_of(b.L[0].z, L.z, 1e-13, v3_norm(L));
            error[d] = fabs(fl_body_kinetic_energy(&b, 0) / E - 1.0);
            fl_bodies_free(&b);
        }
        assert_true(error[0] < 1e-2);
        assert_true(error[1] < 0.35 * error[0] + 1e-6); /* a quarter, and terms of higher order */
    }
}

/* The work of a constraint is force times prescribed velocity, to rounding, and zero where that is zero.
 * Kinetic energy is the sum of that work and of the other work. */
static void the_work_of_constraints_is_recorded(void **state)
{
    const double speed[] = {0.0, 3.0};
    (void)state;
    for (int c = 0; c < 2; c++) {
        fl_rng g = fl_rng_of(test_seed(), 5, FL_RNG_TEST);
        fl_bodies b;
        random_body(&b, &g, v3(1, 1.5, 2.2), FL_DOF_X | TURNS);
        b.v[0] = v3(speed[c], 0, 0);
        b.f[0] = v3(-70.0, 5.0, 0.0);
        b.t[0] = v3(10, -20, 30);
        const double dt = 0.01, before = fl_body_kinetic_energy(&b, 0);
        const int steps = 1000;
        for (int k = 0; k < steps; k++) {
            fl_kick(&b, 0, 0.5 * dt);
            fl_drift(&b, 0, dt);
            fl_kick(&b, 0, 0.5 * dt);
        }
        assert_near_of(b.work_of_constraints[0], 70.0 * speed[c] * dt * steps, 1e-12, 70.0 * dt * steps);
        assert_near_of(fl_body_kinetic_energy(&b, 0) - before,
                       b.work_of_constraints[0] + v3_dot(b.f[0], b.x[0]), 1e-12, 70.0 * dt * steps);
        fl_bodies_free(&b);
    }
}

/* A prescribed rotation: an asymmetric body driven about z without external torque. The work of the drive is
 * the gain of kinetic energy, zero over whole turns. */
static void the_work_of_a_prescribed_rotation_is_recorded(void **state)
{
    fl_rng g = fl_rng_of(test_seed(), 6, FL_RNG_TEST);
    fl_bodies b;
    (void)state;
    random_body(&b, &g, v3(1, 1.5, 2.2), FL_DOF_RZ);
    fl_body_set_spin(&b, 0, v3(0.2, 0.1, 2.0));
    const double before = fl_body_kinetic_energy(&b, 0);
    double worst = 0.0, largest = 0.0;
    for (int k = 0; k < 4000; k++) {
        fl_drift(&b, 0, 5e-4);
        worst = fmax(worst, fabs(fl_body_kinetic_energy(&b, 0) - before - b.work_of_constraints[0]));
        largest = fmax(largest, fabs(b.work_of_constraints[0]));
        assert_true(b.w[0].z == 2.0);
    }
    assert_true(largest > 0.01 * before);
    assert_near_of(worst, 0.0, 1e-5, before); /* order 2 of 5e-4 s at 2 rad/s */
    fl_bodies_free(&b);
}

/* Through the solver: a floe of a group, fixed in z and all rotations and driven in x, pushes another one.
 * The ledger closes with the work of the drive. */
static void a_driven_group_does_the_work_on_what_it_pushes(void **state)
{
    double residual[2];
    (void)state;
    for (int d = 0; d < 2; d++) {
        lab l;
        fl_err err = {0};
        fl_poly p = {0};
        lab_start(&l);
        lab_set(&l, "material.ice.young=10 MPa");
        lab_set(&l, "contact.restitution=0.3");
        lab_set(&l, "contact.friction=0.2");
        lab_set(&l, "group.pusher.fixed=x y z rx ry rz");
        lab_set(&l, "group.pusher.velocity=0.5 0 0");
        assert_int_equal(fl_poly_box(&p, v3(0.45, 0.45, 0.45), &err), 0);
        assert_int_equal(
            fl_ice_field_add(&l.field, 1, 0.05, &p, NULL, "pusher", v3(0, 0, 0), v3(0, 0, 0), &err), 0);
        lab_box(&l, v3(1.1, 0.1, 0.05), v3(0.5, 0.5, 0.5), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 0);
        l.w.dt /= 1 << d;
        assert_int_equal(lab_run(&l, (int64_t)(1.0 / l.w.dt)), 0);
        fl_energy_update(&l.w);
        assert_near(l.w.b.x[0].x, 0.5 * l.w.dt * (double)l.w.step, 1e-12);
        assert_true(l.w.b.v[1].x > 0.4);
        assert_true(l.w.ledger.drive_now >= l.w.ledger.damping_now + 0.5 * l.w.b.m[1] * 0.16);
        residual[d] = fabs(l.w.ledger.residual) / l.w.ledger.drive_now;
        lab_free(&l);
    }
    assert_true(residual[0] < 1e-2);
    assert_true(residual[1] < 0.5 * residual[0]); /* order 2, a quarter, over few steps */
}

/* Fixed directions keep their speed with added mass, and the energy ledger closes. */
static void prescribed_velocity_with_added_mass(void **state)
{
    (void)state;
    const unsigned fixed[] = {0,
                              FL_DOF_X,
                              FL_DOF_X | FL_DOF_Y | FL_DOF_Z,
                              FL_DOF_Z | FL_DOF_RX,
                              TURNS,
                              FL_DOF_Y | FL_DOF_RY | FL_DOF_RZ};
    for (int k = 0; k < 6; k++) {
        fl_rng g = fl_rng_of(test_seed(), 60 + k, FL_RNG_TEST);
        fl_bodies b;
        fl_err err = {0};
        double off[2];
        for (int fine = 0; fine < 2; fine++) {
            g = fl_rng_of(test_seed(), 60 + k, FL_RNG_TEST);
            random_body(&b, &g, v3(1, 2, 3), fixed[k]);
            assert_int_equal(fl_bodies_alloc_added_mass(&b, &err), 0);
            b.added_mass[0] = v3(0.3, 1.0, 5.0);
            const fl_vec3 v = b.v[0];
            const double start = fl_body_kinetic_energy(&b, 0);
            for (int s = 0; s < (fine ? 2000 : 1000); s++) {
                fl_kick(&b, 0, fine ? 5e-4 : 1e-3); /* no force: the constraint does no work */
                fl_drift(&b, 0, fine ? 1e-3 : 2e-3);
            }
            if (fixed[k] & FL_DOF_X) assert_true(b.v[0].x == v.x);
            if (fixed[k] & FL_DOF_Y) assert_true(b.v[0].y == v.y);
            if (fixed[k] & FL_DOF_Z) assert_true(b.v[0].z == v.z);
            off[fine] = fabs(fl_body_kinetic_energy(&b, 0) - b.work_of_constraints[0] - start);
            assert_near_of(off[fine], 0.0, 1e-3, start);
            fl_bodies_free(&b);
        }
        assert_true(off[1] < 0.6 * off[0] + 1e-12);
    }
}

enum { SEVERAL = 53 };

/* Symmetric tops, bricks and spheres, some at rest, some with `wild` times the spin of the others. */
static void make_bodies(fl_bodies *b, double spin_factor)
{
    fl_err err = {0};
    assert_int_equal(fl_bodies_alloc(b, SEVERAL, SEVERAL, &err), 0);
    for (int32_t i = 0; i < SEVERAL; i++) {
        fl_rng g = fl_rng_of(test_seed(), i, FL_RNG_TEST);
        b->m[i] = fl_rng_in(&g, 1, 3);
        b->invm[i] = 1.0 / b->m[i];
        b->is_isotropic[i] = i % 7 > 4;
        fl_body_set_inertia(b, i,
                            b->is_isotropic[i] ? v3(0.7, 0.7, 0.7)
                            : i % 7 == 1       ? v3(1, 1, 2)
                            : i % 7 == 2       ? v3(1, 2, 2)
                                               : v3(1, 2, 2.5));
        b->bounding_radius[i] = b->is_isotropic[i] ? 0.0 : 1.5;
        b->q[i] = shape_rotation(&g);
        b->v[i] = random_vector(&g), b->f[i] = random_vector(&g), b->t[i] = random_vector(&g);
        fl_body_update_spin(b, i);
        const fl_vec3 spin = random_vector(&g);
        if (i % 5) fl_body_set_spin(b, i, v3_scale(i % 11 == 3 ? spin_factor : 1.0, spin));
        else b->t[i] = v3(0, 0, 0);
    }
}

/* Adds water mass and a flow; spheres have isotropic added mass. */
static void add_water(fl_bodies *b)
{
    fl_rng g = fl_rng_of(test_seed(), 2, FL_RNG_TEST);
    assert_int_equal(fl_bodies_alloc_added_mass(b, NULL), 0);
    for (int32_t i = 0; i < SEVERAL; i++) {
        const double even = fl_rng_in(&g, 0.1, 1.0);
        b->added_mass[i] =
            b->is_isotropic[i] ? v3(even, even, even) : v3(even, fl_rng_in(&g, 0.1, 1.0), i % 3);
        b->flow_velocity[i] = i % 4 ? random_vector(&g) : v3(0, 0, 0);
    }
}

static void move_in_batches(fl_bodies *b, int32_t from, int32_t to, double h, int with_kick)
{
    int32_t at[FL_BODY_BATCH];
    fl_body_batch_water along, *const water = b->added_mass ? &along : NULL;
    fl_body_batch s;
    for (int32_t k = from; k < to; k++) at[k - from] = k;
    fl_body_batch_load(&s, b, at, to - from, h);
    fl_body_batch_load_forces(&s, b);
    fl_body_batch_load_pose(&s, b);
    if (water) fl_body_batch_load_water(water, b, &s);
    if (with_kick && !water) fl_body_batch_kick_momentum(&s);
    else fl_body_batch_update_axes(&s), fl_body_batch_kick(&s, water);
    const int done = fl_body_batch_drift(&s, water);
    fl_body_batch_store_velocities(&s, b);
    if (done) fl_body_batch_store_pose(&s, b);
    if (done && water) fl_body_batch_store_water(&s, water, b);
    for (int32_t k = from; k < to && !done; k++) fl_drift(b, k, 2.0 * h);
}

/* Runs of spheres and of other bodies, in batches. */
static void move_in_full_batches(fl_bodies *b, int32_t from, int32_t to, double h, double dt, int with_kick)
{
    for (int32_t i = from, end; i < to; i = end) {
        for (end = i + 1; end < to && b->is_isotropic[end] == b->is_isotropic[i] && end < i + FL_BODY_BATCH;)
            end++;
        if (!b->is_isotropic[i]) move_in_batches(b, i, end, h, with_kick);
        else if (!b->added_mass) fl_kick_drift_isotropic(b, i, end, h, dt);
        else
            for (int32_t k = i; k < end; k++) fl_kick(b, k, h), fl_drift(b, k, dt);
    }
}

static void a_batch_has_the_bits_of_single_bodies(void **state)
{
    (void)state;
    /* low orders of the series suffice for some bodies; some rotate by more than a radian a step */
    const double spin_factor[] = {1.0, 5.0, 500.0};
    for (int way = 0; way < 6; way++) {
        fl_bodies one, all;
        make_bodies(&one, spin_factor[way % 3]), make_bodies(&all, spin_factor[way % 3]);
        if (way >= 3) add_water(&one), add_water(&all);
        for (int k = 0; k < 40; k++) {
            for (int32_t i = 0; i < SEVERAL; i++) {
                fl_kick(&one, i, 0.005);
                fl_drift(&one, i, 0.01);
            }
            move_in_full_batches(&all, 0, 20, 0.005, 0.01, k % 2);
            move_in_full_batches(&all, 20, SEVERAL, 0.005, 0.01, k % 2);
            for (int32_t i = 0; i < SEVERAL; i++) {
                assert_memory_equal(&one.x[i], &all.x[i], sizeof one.x[i]);
                assert_memory_equal(&one.v[i], &all.v[i], sizeof one.v[i]);
                assert_memory_equal(&one.L[i], &all.L[i], sizeof one.L[i]);
                assert_memory_equal(&one.q[i], &all.q[i], sizeof one.q[i]);
                assert_memory_equal(&one.w[i], &all.w[i], sizeof one.w[i]);
                assert_memory_equal(&one.odometer[i], &all.odometer[i], sizeof one.odometer[i]);
                if (one.added_mass)
                    assert_memory_equal(&one.flow_work[i], &all.flow_work[i], sizeof one.flow_work[i]);
            }
        }
        fl_bodies_free(&one), fl_bodies_free(&all);
    }
}

/* Both series, on either side of the argument where the longer one begins. */
static void the_series_agree_with_the_functions(void **state)
{
    (void)state;
    for (double x2 = 1e-14; x2 <= Q_HALF_ANGLE2_MAX; x2 *= 1.01) {
        const long double x = sqrtl((long double)x2), half = sinl(0.5L * x);
        assert_true(fabsl(q_versine(x2) - 2.0L * half * half) < 1e-18L + 2e-16L * (long double)x2);
        assert_true(fabsl(q_sinc(x2) - sinl(x) / x) < 1.2e-16L);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(prescribed_velocity_with_added_mass),
        cmocka_unit_test(a_batch_has_the_bits_of_single_bodies),
        cmocka_unit_test(the_series_agree_with_the_functions),
        cmocka_unit_test(a_kick_changes_only_momenta),
        cmocka_unit_test(a_symmetric_top_turns_exactly),
        cmocka_unit_test(a_drift_is_reversible),
        cmocka_unit_test(the_travel_counter_is_an_upper_bound),
        cmocka_unit_test(fixed_directions_stay),
        cmocka_unit_test(two_fixed_rotations_leave_an_axle),
        cmocka_unit_test(one_fixed_rotation_conserves_energy),
        cmocka_unit_test(the_work_of_constraints_is_recorded),
        cmocka_unit_test(the_work_of_a_prescribed_rotation_is_recorded),
        cmocka_unit_test(a_driven_group_does_the_work_on_what_it_pushes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
