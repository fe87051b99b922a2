/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/body_step.h"
#include "sim/energy_balance.h"
#include "support/near.h"
#include <math.h>
#include <string.h>
#include "sim/critical_step.h"
#include "sim/step.h"
#include "support/small_world.h"
#include "support/shapes.h"
#include "water/still_water_batch.h"

/* A box of 10 x 10 x 1 m with its centre at z, in water of 1025 kg/m3. */
static void make_floe(lab *l, double z, fl_vec3 v, fl_vec3 spin)
{
    lab_start(l);
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.density=1025");
    lab_set(l, "water.drag_force_coef=0.005");
    lab_set(l, "water.drag_moment_coef=0.005");
    lab_box(l, v3(0, 0, z), v3(5, 5, 0.5), 0.05, q_one(), v, spin);
}

#define DRAFT (900.0 / 1025.0)

static void buoyancy_carries_the_weight_at_the_draft(void **state)
{
    (void)state;
    lab l;
    make_floe(&l, 0.5 - DRAFT, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-3);
    fl_world *w = &l.w;
    const double weight = 90000.0 * 9.81;
    assert_near(w->b.m[0], 90000.0, 1e-14);
    assert_near(w->sea.buoyancy[0], weight, 1e-14);
    assert_near_of(w->b.f[0].z, 0.0, 1e-14, weight);
    assert_near_of(v3_norm(w->b.t[0]), 0.0, 1e-14, weight);
    assert_near(w->sea.wetted_area[0], 100.0 + 40.0 * DRAFT, 1e-14);
    assert_near(w->sea.drag_radius[0], sqrt(50.25), 1e-14);
    /* rho g V d/2: the displaced water is half a draft higher */
    assert_near(fl_environment_energy(&w->sea, &w->b, 0), weight * 0.5 * DRAFT, 1e-13);
    lab_free(&l);
}

/* Lift and energy of a body that is raised: F = -dU/dz, until it leaves the water. */
static void lift_is_the_gradient_of_the_energy(void **state)
{
    (void)state;
    for (int k = 0; k < 30; k++) {
        const double z = -0.7 + 0.05 * k, h = 1e-5;
        lab l;
        make_floe(&l, z, v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 1e-3);
        fl_world *w = &l.w;
        double u[2];
        for (int s = 0; s < 2; s++) {
            w->b.f[0] = w->b.t[0] = v3(0, 0, 0);
            w->b.x[0].z = s ? z + h : z - h;
            fl_environment_force(&w->sea, &w->b, 0);
            u[s] = fl_environment_energy(&w->sea, &w->b, 0);
        }
        w->b.x[0].z = z;
        w->b.f[0] = w->b.t[0] = v3(0, 0, 0);
        fl_environment_force(&w->sea, &w->b, 0);
        assert_near_of(w->b.f[0].z, -(u[1] - u[0]) / (2 * h), 1e-5, 1e6);
        if (z > 0.5)
            assert_true(w->sea.buoyancy[0] == 0.0 && fl_environment_energy(&w->sea, &w->b, 0) == 0.0);
        lab_free(&l);
    }
}

static void drag_is_the_exact_decay_and_records_its_work(void **state)
{
    (void)state;
    lab l;
    make_floe(&l, 0.5 - DRAFT, v3(3, 4, 0), v3(0, 0, 0.1));
    lab_set(&l, "water.current=1 0 0");
    lab_make(&l, 1e-3);
    fl_world *w = &l.w;
    const double kinetic = fl_body_kinetic_energy(&w->b, 0), area = 100.0 + 40.0 * DRAFT;
    const double kappa = 0.5 * 0.005 * 1025 * area / 90000.0, u = sqrt(20.0), h = 7.0;
    fl_environment_drag(&w->sea, &w->b, 0, h, 0);
    const double f = 1.0 / (1.0 + kappa * u * h);
    assert_near(w->b.v[0].x, 1.0 + 2.0 * f, 1e-14);
    assert_near(w->b.v[0].y, 4.0 * f, 1e-14);
    const double spin = 0.5 * 0.005 * 1025 * area * pow(50.25, 1.5) / (90000.0 * 200.0 / 12.0);
    assert_near(w->b.w[0].z, 0.1 / (1.0 + spin * 0.1 * h), 1e-13);
    assert_near(w->sea.drag_loss[0], kinetic - fl_body_kinetic_energy(&w->b, 0), 1e-14);
    /* in two half steps: the same, since the decay is exact */
    lab m;
    make_floe(&m, 0.5 - DRAFT, v3(3, 4, 0), v3(0, 0, 0.1));
    lab_set(&m, "water.current=1 0 0");
    lab_make(&m, 1e-3);
    for (int k = 0; k < 2; k++) fl_environment_drag(&m.w.sea, &m.w.b, 0, 0.5 * h, k);
    assert_near(m.w.b.v[0].y, w->b.v[0].y, 1e-14);
    assert_near(m.w.b.w[0].z, w->b.w[0].z, 1e-13);
    lab_free(&m);
    lab_free(&l);
}

static void wind_acts_on_the_dry_part(void **state)
{
    (void)state;
    lab l;
    make_floe(&l, 0.5 - DRAFT, v3(0, 0, 0), v3(0, 0, 0));
    lab_set(&l, "water.drag_force_coef=0");
    lab_set(&l, "wind.velocity=20 0 0");
    lab_set(&l, "wind.density=1.293");
    lab_set(&l, "wind.drag_coef=0.0015");
    lab_make(&l, 1e-3);
    fl_world *w = &l.w;
    const double dry = 240.0 - (100.0 + 40.0 * DRAFT), kappa = 0.5 * 0.0015 * 1.293 * dry / 90000.0,
                 h = 100.0;
    fl_environment_drag(&w->sea, &w->b, 0, h, 0);
    const double v = 20.0 * (1.0 - 1.0 / (1.0 + kappa * 20.0 * h));
    assert_near(w->b.v[0].x, v, 1e-11);
    assert_near(w->sea.wind_work[0], 45000.0 * v * v, 1e-11);
    assert_true(w->sea.drag_loss[0] == 0.0);
    lab_free(&l);
}

/* Drag of a body that is fixed along x: the prescribed velocity stays, and the constraint does the work. */
static void drag_does_not_move_fixed_directions(void **state)
{
    (void)state;
    lab l;
    make_floe(&l, 0.5 - DRAFT, v3(2, 2, 0), v3(0, 0, 0));
    lab_make(&l, 1e-3);
    fl_world *w = &l.w;
    w->b.fixed_dof[0] = FL_DOF_X;
    const double before = fl_body_kinetic_energy(&w->b, 0);
    fl_environment_drag(&w->sea, &w->b, 0, 10.0, 0);
    assert_true(w->b.v[0].x == 2.0);
    assert_true(w->b.v[0].y < 2.0);
    assert_near(w->b.work_of_constraints[0] - w->sea.drag_loss[0], fl_body_kinetic_energy(&w->b, 0) - before,
                1e-13);
    assert_true(w->b.work_of_constraints[0] > 0.0);
    lab_free(&l);
}

/* A sphere and a capsule float by their round shape. */
static void rounded_bodies_float_by_their_round_shape(void **state)
{
    (void)state;
    const double pi = 3.141592653589793;
    for (int segment = 0; segment < 2; segment++) {
        lab l;
        fl_err err = {0};
        fl_poly p = {0};
        const fl_vec3 v[2] = {v3(0, 0, 0), v3(2, 0, 0)};
        lab_start(&l);
        lab_set(&l, "run.gravity=10");
        lab_set(&l, "water.density=1000");
        assert_int_equal(fl_poly_make(&p, 1 + segment, v, 0, NULL, NULL, &err), 0);
        lab_poly(&l, &p, 0.5, v3(0, 0, 0), v3(0, 0, 0));
        lab_make(&l, 1e-3);
        const double half = 0.5 * (4.0 / 3.0 * pi * 0.125 + segment * 2.0 * pi * 0.25);
        assert_near(l.w.sea.buoyancy[0], 1e4 * half, 1e-9);
        lab_free(&l);
    }
}

/* water.every concerns waves: evaluating still water costs no more than an extrapolation would. */
static void still_water_is_evaluated_in_each_step(void **state)
{
    uint64_t hash[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        lab l;
        make_floe(&l, 0.5 - DRAFT + 0.03, v3(0.1, 0, 0), v3(0.01, 0.02, 0));
        if (k) lab_set(&l, "water.every=1000");
        lab_make(&l, 1e-3);
        assert_null(l.w.sea.sample);
        assert_int_equal(lab_run(&l, 2500), 0);
        hash[k] = fl_state_hash(&l.w);
        lab_free(&l);
    }
    assert_true(hash[0] == hash[1]);
}

static void make_floe_in_ripples(lab *l, double dt, int every)
{
    make_floe(l, 0.5 - DRAFT + 0.03, v3(0, 0, 0), v3(0.01, 0.02, 0));
    lab_set(l, "water.drag_force_coef=0"), lab_set(l, "water.drag_moment_coef=0");
    lab_set(l, "water.wave=airy"), lab_set(l, "water.height=1e-3"), lab_set(l, "water.period=10");
    lab_setf(l, "water.every=%d", every);
    lab_make(l, dt);
}

/* Heave, roll and pitch of a floe without drag for 40 periods, the waves sampled 20 times in each.
 * Extrapolating its buoyancy linearly made the motions grow to five times their amplitude. */
static void heave_between_evaluations_gains_no_energy(void **state)
{
    enum { RUNS = 10 };
    double heave[RUNS], turn[RUNS];
    lab l;
    (void)state;
    make_floe_in_ripples(&l, 5e-3, 18);
    for (int k = 0; k < RUNS; k++) {
        heave[k] = turn[k] = 0.0;
        for (int s = 0; s < 1500; s++) {
            assert_int_equal(lab_run(&l, 1), 0);
            const fl_quat q = l.w.b.q[0];
            heave[k] = fmax(heave[k], fabs(l.w.b.x[0].z - (0.5 - DRAFT)));
            turn[k] = fmax(turn[k], hypot(q.x, q.y));
        }
    }
    assert_near(heave[RUNS - 1], heave[0], 0.02);
    assert_near(turn[RUNS - 1], turn[0], 0.02);
    lab_free(&l);
}

/* rho g A/m of a floating box 1 m high at draft DRAFT is g/DRAFT. */
static void waves_are_sampled_often_enough(void **state)
{
    fl_err err = {0};
    int rotational;
    lab l;
    (void)state;
    make_floe_in_ripples(&l, 5e-3, 18);
    fl_world *w = &l.w;
    w->b.q[0] = q_one();
    assert_near(fl_environment_omega2(&w->sea, &w->b, 0, &rotational), 9.81 / DRAFT, 1e-12);
    assert_false(rotational);
    assert_int_equal(fl_check_wave_sampling(w, &err), 0);
    w->sea.sample_every = 19;
    assert_int_equal(fl_check_wave_sampling(w, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_string_equal(err.text,
                        "water.every: 19 steps of 0.005 s, and body 1 heaves with a period of 1.88 s: 19 "
                        "samples in it; at most 18 steps expected, or a smaller run.dt");
    /* a fixed floe does not move, and only the waves remain */
    w->b.fixed_dof[0] = FL_DOF_Z | FL_DOF_RX | FL_DOF_RY;
    w->sea.sample_every = 100;
    assert_int_equal(fl_check_wave_sampling(w, &err), 0);
    w->sea.sample_every = 101;
    err = (fl_err){0};
    assert_int_equal(fl_check_wave_sampling(w, &err), -1);
    assert_non_null(strstr(err.text, ", and the waves have a period of 10 s: 19 samples in it; at most 100"));
    lab_free(&l);
}

static void a_scene_without_water_allocates_none(void **state)
{
    (void)state;
    lab l;
    lab_start(&l);
    lab_sphere(&l, v3(0, 0, 0), 1.0, v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-3);
    assert_int_equal(l.w.sea.n, 0);
    assert_null(l.w.sea.hull);
    lab_free(&l);
}

enum { SEVERAL = 45 };

/* Prisms and other shapes: afloat upright or turned over, inclined, deep under water, high above; some at
 * rest. */
static void add_random_float(lab *l, int wind, int shear, int along)
{
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "water.current=0.5 0.1 0");
    if (shear) lab_set(l, "water.profile=linear");
    if (shear) lab_set(l, "water.profile_depth=3");
    if (wind) lab_set(l, "wind.velocity=8 -3 0");
    if (along) lab_set(l, "water.added_mass=0.2 0.1 0.7");
    for (int32_t k = 0; k < SEVERAL; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        fl_poly p = {0};
        if (k % 6 == 5) shape_random_polytope(&p, &g, 4);
        else shape_random_prism(&p, &g);
        const fl_vec3 upright = v3_scale(0.05, shape_direction(&g));
        const fl_quat q = k % 4 == 3   ? shape_rotation(&g)
                          : k % 4 == 2 ? q_mul(q_of_vector(upright), (fl_quat){0, 1, 0, 0})
                                       : q_of_vector(upright);
        const double z = k % 9 == 7 ? -9.0 : k % 9 == 8 ? 9.0 : fl_rng_in(&g, -0.1, 0.1);
        shape_move(&p, q, v3(20.0 * k, 0, z));
        const fl_vec3 v = shape_direction(&g), spin = shape_direction(&g);
        lab_poly(l, &p, 0.01, k % 7 ? v : v3(0.5, 0.1, 0), k % 5 ? spin : v3(0, 0, 0));
    }
    lab_make(l, 1e-3);
}

static void make_floats(lab *l, int wind, int shear, int along, int facets)
{
    lab_start(l);
    if (facets) lab_set(l, "water.drag=facet");
    if (facets && wind) lab_set(l, "wind.drag=facet");
    if (facets) { /* rounded shapes have no facets */
        const fl_vec3 ends[2] = {{-0.5, 50, 0}, {0.5, 50, 0}};
        fl_err err = {0};
        fl_poly rod;
        assert_int_equal(fl_poly_make(&rod, 2, ends, 0, NULL, NULL, &err), 0);
        lab_poly(l, &rod, 0.3, v3(0.3, 0, 0), v3(0, 0.2, 0.1));
    }
    add_random_float(l, wind, shear, along);
}

static void assert_same_bits(const void *a, const void *b, size_t bytes) { assert_memory_equal(a, b, bytes); }

/* A force with an impulse: an acceleration along x, and a rotation that decays. */
static void accelerate(const fl_environment *s, fl_bodies *b, int32_t i, double h)
{
    const double rest = 1.0 / (1.0 + 0.2 * h);
    (void)s;
    b->v[i].x += 0.3 * h;
    b->L[i] = v3_scale(rest, b->L[i]), b->w[i] = v3_scale(rest, b->w[i]);
}

static const fl_water_force EXTRA_FORCE = {.name = "acceleration", .impulse = accelerate};

static void add_force(fl_environment *s) { s->impulse[s->impulses++] = &EXTRA_FORCE; }

/* It acts in both halves, its work is drag, and a constraint holds against it. */
static void work_of_an_impulse_is_booked(void **state)
{
    (void)state;
    const double h = 0.5;
    for (int fixed = 0; fixed < 2; fixed++) {
        lab l;
        make_floe(&l, 9.0, v3(1, 2, 0), v3(0, 0, 0.4)); /* in the air: without drag */
        lab_make(&l, 1e-3);
        fl_bodies *b = &l.w.b;
        if (fixed) b->fixed_dof[0] = FL_DOF_X;
        add_force(&l.w.sea);
        const double before = fl_body_kinetic_energy(b, 0);
        for (int back = 0; back < 2; back++) fl_environment_drag(&l.w.sea, b, 0, h, back);
        assert_near(b->v[0].x, fixed ? 1.0 : 1.0 + 2.0 * 0.3 * h, 1e-14);
        assert_near(b->w[0].z, 0.4 / (1.1 * 1.1), 1e-14);
        assert_near(b->work_of_constraints[0] - l.w.sea.drag_loss[0], fl_body_kinetic_energy(b, 0) - before,
                    1e-11);
        assert_true((b->work_of_constraints[0] < 0.0) == fixed);
        lab_free(&l);
    }
}

static void water_forces_of_a_batch_have_the_same_bits(void **state)
{
    (void)state;
    int32_t afloat = 0;
    for (int way = 0; way < 32; way++) {
        const double h = way & 4 ? 0.3 : 1e-3;
        const size_t numbers = SEVERAL * sizeof(double), vectors = SEVERAL * sizeof(fl_vec3);
        lab l, m;
        make_floats(&l, way & 1, way & 2, way & 8, way & 16),
            make_floats(&m, way & 1, way & 2, way & 8, way & 16);
        fl_world *one = &l.w, *all = &m.w;
        if (way & 4) add_force(&one->sea), add_force(&all->sea);
        for (int32_t k = 0; k < SEVERAL; k++) {
            fl_body_external_force(one, k);
            fl_environment_drag(&one->sea, &one->b, k, h, 0);
            fl_environment_drag(&one->sea, &one->b, k, h, 1);
        }
        for (int32_t from = 0, n; from < SEVERAL; from += n) {
            int32_t at[FL_BODY_BATCH], left[FL_BODY_BATCH];
            fl_body_batch_water along, *const water = way & 8 ? &along : NULL;
            fl_body_batch s;
            n = way & 4 ? 1 : 1 + (from + way) % FL_BODY_BATCH;
            if (n > SEVERAL - from) n = SEVERAL - from;
            for (int32_t k = 0; k < n; k++) at[k] = from + k;
            fl_body_batch_load(&s, &all->b, at, n, h);
            fl_body_batch_update_axes(&s);
            fl_body_batch_set_weight(&s, all->gravity);
            const int32_t others = fl_still_water_batch_force(&all->sea, &all->b, &s, left);
            fl_body_batch_store_forces(&s, &all->b);
            for (int32_t k = 0; k < others; k++) fl_body_external_force(all, from + left[k]);
            if (water) fl_body_batch_load_water(water, &all->b, &s);
            fl_still_water_batch_drag(&all->sea, &all->b, &s, water, 0);
            fl_still_water_batch_drag(&all->sea, &all->b, &s, water, 1);
            fl_body_batch_store_velocities(&s, &all->b);
            afloat += n - others;
        }
        assert_same_bits(one->b.f, all->b.f, vectors), assert_same_bits(one->b.t, all->b.t, vectors);
        assert_same_bits(one->b.v, all->b.v, vectors), assert_same_bits(one->b.w, all->b.w, vectors);
        assert_same_bits(one->b.L, all->b.L, vectors);
        if (way & 8) assert_same_bits(one->b.flow_velocity, all->b.flow_velocity, vectors);
        assert_true(!one->sea.flow_velocity == !(way & 2) && !one->sea.wind_work == !(way & 1));
        if (one->sea.flow_velocity) assert_same_bits(one->sea.flow_velocity, all->sea.flow_velocity, vectors);
        assert_same_bits(one->sea.wetted_area, all->sea.wetted_area, numbers),
            assert_same_bits(one->sea.buoyancy, all->sea.buoyancy, numbers);
        assert_same_bits(one->sea.drag_loss, all->sea.drag_loss, numbers);
        if (one->sea.wind_work) assert_same_bits(one->sea.wind_work, all->sea.wind_work, numbers);
        lab_free(&l), lab_free(&m);
    }
    assert_true(afloat > 32 * SEVERAL / 8 && afloat < 32 * SEVERAL / 4 * 3);
}

/* Samples the waves twice; the second sample is a little later and elsewhere, so that all values change. */
static void sample_waves_twice(fl_world *w)
{
    for (int pass = 0; pass < 2; pass++) {
        w->sea.sample_now = 1, w->sea.time = 0.02 * pass;
        for (int32_t k = 0; k < SEVERAL; k++) {
            fl_body_external_force(w, k);
            w->b.x[k] = v3_madd(w->b.x[k], 0.02, w->b.v[k]);
            w->b.q[k] = q_mul(q_of_vector(v3_scale(0.02, w->b.w[k])), w->b.q[k]);
        }
    }
    w->sea.sample_now = 0, w->sea.time = 0.03;
}

static void wave_forces_of_a_batch_have_the_same_bits(void **state)
{
    (void)state;
    const size_t vectors = SEVERAL * sizeof(fl_vec3);
    int32_t afloat = 0;
    for (int way = 0; way < 4; way++) {
        lab l, m;
        for (int k = 0; k < 2; k++) {
            lab *const to = k ? &m : &l;
            lab_start(to);
            lab_set(to, "water.wave=airy"), lab_set(to, "water.height=0.4"), lab_set(to, "water.period=3");
            lab_set(to, "water.direction=30 deg"), lab_set(to, "water.every=10");
            if (way & 1) lab_set(to, "water.drag=facet");
            add_random_float(to, 0, 0, way & 2);
        }
        fl_world *one = &l.w, *all = &m.w;
        sample_waves_twice(one), sample_waves_twice(all);
        for (int32_t k = 0; k < SEVERAL; k++) fl_body_external_force(one, k);
        for (int32_t from = 0, n; from < SEVERAL; from += n) {
            int32_t at[FL_BODY_BATCH], left[FL_BODY_BATCH];
            fl_body_batch s;
            n = 1 + (from + way) % FL_BODY_BATCH;
            if (n > SEVERAL - from) n = SEVERAL - from;
            for (int32_t k = 0; k < n; k++) at[k] = from + k;
            fl_body_batch_load(&s, &all->b, at, n, 1e-3);
            fl_body_batch_update_axes(&s);
            fl_body_batch_set_weight(&s, all->gravity);
            assert_true(fl_still_water_batch_applies(&all->sea));
            const int32_t others = fl_still_water_batch_force(&all->sea, &all->b, &s, left);
            fl_body_batch_store_forces(&s, &all->b);
            for (int32_t k = 0; k < others; k++) fl_body_external_force(all, from + left[k]);
            afloat += n - others;
        }
        assert_same_bits(one->b.f, all->b.f, vectors), assert_same_bits(one->b.t, all->b.t, vectors);
        assert_same_bits(one->sea.water_force, all->sea.water_force, vectors),
            assert_same_bits(one->sea.water_moment, all->sea.water_moment, vectors);
        assert_same_bits(one->sea.flow_velocity, all->sea.flow_velocity, vectors);
        if (way & 2) assert_same_bits(one->b.flow_velocity, all->b.flow_velocity, vectors);
        lab_free(&l), lab_free(&m);
    }
    assert_true(afloat > 4 * SEVERAL / 8 && afloat < 4 * SEVERAL / 4 * 3);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buoyancy_carries_the_weight_at_the_draft),
        cmocka_unit_test(lift_is_the_gradient_of_the_energy),
        cmocka_unit_test(drag_is_the_exact_decay_and_records_its_work),
        cmocka_unit_test(wind_acts_on_the_dry_part),
        cmocka_unit_test(drag_does_not_move_fixed_directions),
        cmocka_unit_test(rounded_bodies_float_by_their_round_shape),
        cmocka_unit_test(work_of_an_impulse_is_booked),
        cmocka_unit_test(water_forces_of_a_batch_have_the_same_bits),
        cmocka_unit_test(wave_forces_of_a_batch_have_the_same_bits),
        cmocka_unit_test(still_water_is_evaluated_in_each_step),
        cmocka_unit_test(heave_between_evaluations_gains_no_energy),
        cmocka_unit_test(waves_are_sampled_often_enough),
        cmocka_unit_test(a_scene_without_water_allocates_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
