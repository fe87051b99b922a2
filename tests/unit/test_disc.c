/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/pi.h"
#include "base/rng.h"
#include "body/integrate.h"
#include "bond/disc_batch.h"
#include "contact/bond_list.h"
#include "sim/energy_balance.h"
#include "sim/inflow.h"
#include "sphere/contact_list.h"
#include "support/near.h"
#include "support/small_world.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* A disc of 0.1 m between spheres of 0.2 m, E = 1 GPa, G/E = 0.4. */
#define R 0.1
#define E 1e9
#define RATIO 0.4
#define LENGTH 0.2
#define AREA (PI * R * R)
#define INERTIA (PI * R * R * R * R / 4.0)

static fl_disc_class class_of(double ductility, double damping)
{
    return (fl_disc_class){LENGTH, E * AREA / LENGTH, RATIO, R, 0.5, damping, 1.0, ductility};
}

static const fl_disc_law LAW = {.tension = 1e6, .cohesion = 0.5e6, .friction = 0.3, .moment_factor = 1.0};

/* Moves the second sphere by u and turns it by a, in n steps from the state of m; returns the last forces. */
static fl_disc_wrench moved(const fl_disc_law *law, const fl_disc_class *c, fl_disc_memory *m, fl_vec3 *d,
                            fl_vec3 u, fl_vec3 a, int n)
{
    const double dt = 1e-5;
    fl_disc_wrench f = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int k = 0; k < n; k++) {
        const fl_vec3 v = v3_scale(1.0 / (n * dt), u);
        *d = v3_madd(*d, dt, v);
        const fl_disc_pose at = {*d, ZERO, v, ZERO, v3_scale(1.0 / (n * dt), a)};
        f = fl_disc_force(law, c, 1.0, &at, dt, m);
    }
    return f;
}

/* N = E A/l s, S = G A/l s, M = E I/l a, T = G J/l a; couples and forces balance about any point. */
static void springs_are_those_of_a_beam(void **state)
{
    const fl_disc_class c = class_of(1.5, 0.0);
    const double s = 1e-6, G = RATIO * E;
    (void)state;
    for (int k = 0; k < 4; k++) {
        fl_disc_memory m = {0};
        fl_vec3 d = v3(LENGTH, 0, 0);
        const fl_vec3 u = k == 0   ? v3(s, 0, 0)
                          : k == 1 ? v3(0, s, 0)
                                   : ZERO,
                      a = k == 2   ? v3(0, s, 0)
                          : k == 3 ? v3(s, 0, 0)
                                   : ZERO;
        const fl_disc_wrench f = moved(&LAW, &c, &m, &d, u, a, 10);
        if (k == 0) assert_near(f.force.x, E * AREA / LENGTH * s, 1e-6);
        if (k == 1) assert_near(f.force.y, G * AREA / LENGTH * s, 1e-4);
        if (k == 2) assert_near(m.M.y, E * INERTIA / LENGTH * s, 1e-4);
        if (k == 3) assert_near(m.M.x, G * 2.0 * INERTIA / LENGTH * s, 1e-4);
        if (k == 2) assert_near(f.force.z, G * AREA / LENGTH * s * 0.5 * LENGTH, 1e-4);
        const fl_vec3 sum = v3_add(v3_add(f.couple_i, f.couple_j), v3_cross(d, v3_neg(f.force)));
        assert_near_of(v3_norm(sum), 0, 1e-12, v3_norm(f.couple_i) + 1e-9);
    }
}

/* Breaks at sigma_t A, c A, sigma_t I/R, c J/R. */
static void strengths_are_those_of_the_rim(void **state)
{
    const fl_disc_class c = class_of(1.5, 0.0);
    const double G = RATIO * E, most[4] = {LAW.tension * LENGTH / E, LAW.cohesion * LENGTH / G,
                                           LAW.tension * LENGTH / (E * R), LAW.cohesion * LENGTH / (G * R)};
    (void)state;
    for (int k = 0; k < 4; k++) {
        for (int over = 0; over < 2; over++) {
            fl_disc_memory m = {0};
            fl_vec3 d = v3(LENGTH, 0, 0);
            const double s = most[k] * (over ? 1.002 : 0.998);
            const fl_vec3 u = k == 0   ? v3(s, 0, 0)
                              : k == 1 ? v3(0, s, 0)
                                       : ZERO,
                          a = k == 3 ? v3(s, 0, 0) : ZERO;
            if (k == 2) { /* both turn apart: no shear */
                for (int n = 0; n < 100; n++) {
                    const fl_disc_pose at = {d, ZERO, ZERO, v3(0, -s / 2e-3, 0), v3(0, s / 2e-3, 0)};
                    fl_disc_force(&LAW, &c, 1.0, &at, 1e-5, &m);
                }
            } else moved(&LAW, &c, &m, &d, u, a, 100);
            assert_int_equal(m.lambda > 1.0, over);
        }
    }
}

/* In tension the force falls linearly to 0 at f times the separation of the peak, the secant leads back, and
 * f sigma_t^2 l/(2 E) per area is dissipated. */
static void softening_takes_the_fracture_energy(void **state)
{
    const fl_disc_class c = class_of(2.5, 0.0);
    const double peak = LAW.tension * LENGTH / E, top = LAW.tension * AREA;
    fl_disc_memory m = {0};
    fl_vec3 d = v3(LENGTH, 0, 0);
    (void)state;
    fl_disc_wrench f = moved(&LAW, &c, &m, &d, v3(1.75 * peak, 0, 0), ZERO, 20000);
    assert_near(f.force.x, 0.5 * top, 1e-3);
    f = moved(&LAW, &c, &m, &d, v3(-0.875 * peak, 0, 0), ZERO, 1000);
    assert_near(f.force.x, 0.25 * top, 1e-3);
    f = moved(&LAW, &c, &m, &d, v3(1.7 * peak, 0, 0), ZERO, 20000);
    assert_true(fl_disc_is_broken(&c, m.lambda));
    assert_near_of(f.force.x, 0, 1e-12, top);
    assert_near(m.dissipated, 2.5 * 0.5 * LAW.tension * LAW.tension * LENGTH / E * AREA, 1e-3);
    f = moved(&LAW, &c, &m, &d, v3(-3.0 * peak, 0, 0), ZERO, 1000); /* and presses again */
    assert_near(f.force.x, -E * AREA / LENGTH * (LENGTH - d.x), 1e-9);
}

/* Pressed at p, broken in shear: friction mu p A remains; internal friction adds mu_i p to c. */
static void shear_falls_to_friction(void **state)
{
    const fl_disc_class c = class_of(1.5, 0.0);
    fl_disc_law law = LAW;
    const double press = 1e-5, p = E * press / LENGTH, G = RATIO * E;
    (void)state;
    for (int with = 0; with < 2; with++) {
        fl_disc_memory m = {0};
        fl_vec3 d = v3(LENGTH - press, 0, 0);
        law.internal_friction = with ? 0.8 : 0.0;
        const double first = (law.cohesion + law.internal_friction * p) * LENGTH / G;
        moved(&law, &c, &m, &d, v3(0, 0.99 * first, 0), ZERO, 1000);
        assert_true(m.lambda < 1.0);
        const fl_disc_wrench f = moved(&law, &c, &m, &d, v3(0, 0.9 * first, 0), ZERO, 1000);
        assert_true(fl_disc_is_broken(&c, m.lambda));
        const double N = c.kn * (LENGTH - v3_norm(d)); /* sliding opens it a little */
        assert_near(v3_norm(v3_madd(f.force, N / v3_norm(d), d)), 0.3 * N, 1e-6);
    }
}

/* A loaded bond that turns with its spheres keeps its load. */
static void a_rigid_motion_changes_nothing(void **state)
{
    const fl_disc_class c = class_of(1.5, 0.0);
    fl_disc_memory m = {0};
    fl_vec3 d = v3(LENGTH, 0, 0);
    (void)state;
    moved(&LAW, &c, &m, &d, v3(0, 5e-5, 0), v3(2e-4, 0, 1e-4), 100);
    const double S = v3_norm(m.S), M = v3_norm(m.M), U = fl_disc_energy(&c, &m, d);
    const fl_vec3 w = v3(0.3, -0.7, 0.4), x = d;
    for (int k = 0; k < 100000; k++) {
        const fl_vec3 mid = v3_madd(d, 0.5e-4, v3_cross(w, d)), v = v3_cross(w, mid);
        d = v3_madd(d, 1e-4, v);
        d = v3_scale(v3_norm(x) / v3_norm(d), d);
        const fl_disc_pose at = {d, ZERO, v, w, w};
        fl_disc_force(&LAW, &c, 1.0, &at, 1e-4, &m);
    }
    assert_near(v3_norm(m.S), S, 1e-4);
    assert_near(v3_norm(m.M), M, 1e-6);
    assert_near(fl_disc_energy(&c, &m, d), U, 1e-3);
}

/* Eight discs at a time have the bits of each alone, damped or not. */
static void lanes_have_the_bits_of_one(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        const fl_disc_class c = class_of(1.5, damped ? 1e-4 : 0.0);
        fl_bodies b;
        fl_err err = {0};
        double row[16][FL_LANE_COUNT] = {{0}};
        int32_t i[FL_LANE_COUNT], j[FL_LANE_COUNT];
        uint8_t whole[FL_LANE_COUNT];
        fl_disc_batch_result r;
        uint16_t which[FL_LANE_COUNT] = {0};
        fl_disc_wrench out[FL_LANE_COUNT];
        assert_int_equal(fl_bodies_alloc(&b, 9, 9, &err), 0);
        fl_disc_arrays a = {
            .i = i, .j = j, .scatter = row[13], .is_whole = whole, .which = which, .out = out};
        for (int e = 0; e < 3; e++) {
            a.S[e] = row[e], a.M[e] = row[3 + e];
            a.damping_force[e] = row[6 + e], a.damping_couple[e] = row[9 + e];
        }
        a.damped = damped ? row[12] : NULL;
        for (int k = 0; k < 9; k++) {
            fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
            b.x[k] = v3(LENGTH * k + 1e-6 * fl_rng_in(&g, -1, 1), 1e-6 * fl_rng_in(&g, -1, 1), 0);
            b.v[k] = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1));
            b.w[k] = v3(fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9));
            if (k == 8) continue;
            i[k] = k, j[k] = k + 1, whole[k] = k != 3;
            row[13][k] = fl_rng_in(&g, 0.9, 1.1);
            for (int e = 0; e < 13; e++) row[e][k] = fl_rng_in(&g, -10, 10);
        }
        fl_disc_memory before[FL_LANE_COUNT];
        for (int k = 0; k < FL_LANE_COUNT; k++) {
            before[k] = (fl_disc_memory){.S = v3(row[0][k], row[1][k], row[2][k]),
                                         .M = v3(row[3][k], row[4][k], row[5][k])};
            if (!damped) continue;
            before[k].damping_force = v3(row[6][k], row[7][k], row[8][k]);
            before[k].damping_couple = v3(row[9][k], row[10][k], row[11][k]);
            before[k].damped = row[12][k];
        }
        assert_int_equal(fl_disc_batch_force(&a, 0, FL_LANE_COUNT, &LAW, &c, &b, NULL, 1e-5, &r), 1);
        for (int k = 0; k < FL_LANE_COUNT; k++) {
            fl_disc_memory m = before[k];
            const fl_disc_pose at = {v3_sub(b.x[j[k]], b.x[i[k]]), b.v[i[k]], b.v[j[k]], b.w[i[k]],
                                     b.w[j[k]]};
            const fl_disc_wrench f = fl_disc_force(&LAW, &c, row[13][k], &at, 1e-5, &m);
            const fl_vec3 S = v3(row[0][k], row[1][k], row[2][k]), M = v3(row[3][k], row[4][k], row[5][k]);
            assert_int_equal(r.done[k], k != 3);
            assert_memory_equal(&S, r.done[k] ? &m.S : &before[k].S, sizeof S);
            assert_memory_equal(&M, r.done[k] ? &m.M : &before[k].M, sizeof M);
            if (!r.done[k]) continue;
            assert_memory_equal(&f, &out[k], sizeof f);
            if (damped) assert_memory_equal(&m.damped, &row[12][k], sizeof m.damped);
        }
        fl_bodies_free(&b);
    }
}

/* --- worlds ------------------------------------------------------------------------------------ */

/* side^2 spheres in a square lattice and one layer of hollows, bonded, that are torn apart by their spins and
 * speeds. */
static void make_cluster(lab *l, int side, const char *const *keys)
{
    const double r = 0.1;
    fl_err err = {0};
    lab_start(l);
    lab_set(l, "bond.on=true");
    lab_set(l, "bond.young=10 MPa");
    lab_set(l, "bond.normal_strength=40 kPa");
    lab_set(l, "bond.shear_strength=40 kPa");
    lab_set(l, "bond.softening=stretch");
    lab_set(l, "contact.round_law=linear");
    for (; *keys; keys++) lab_set(l, *keys);
    for (int k = 0; k < side * side; k++) {
        fl_rng g = fl_rng_of(7, k, FL_RNG_TEST);
        const fl_vec3 x = v3(2.0 * r * (k % side), 2.0 * r * (k / side), 0),
                      v = v3(fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1), fl_rng_in(&g, -1, 1)),
                      w = v3(fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9), fl_rng_in(&g, -9, 9));
        lab_sphere(l, x, r, v, w);
    }
    for (int k = 0; k < side * side; k++)
        for (int e = 0; e < 2; e++) {
            const int32_t j = k + (e ? side : 1);
            if (e ? j >= side * side : k % side == side - 1) continue;
            const fl_vec3 x = v3(2.0 * r * (k % side) + (e ? 0 : r), 2.0 * r * (k / side) + (e ? r : 0), 0);
            assert_int_equal(fl_ice_field_add_bond(&l->field, k, j, PI * r * r, 2.0 * r, x, &err), 0);
        }
}

static fl_vec3 angular_momentum(const fl_world *w)
{
    fl_vec3 sum = ZERO;
    for (int32_t i = 0; i < w->n; i++)
        sum = v3_add(sum, v3_add(w->b.L[i], v3_scale(w->b.m[i], v3_cross(w->b.x[i], w->b.v[i]))));
    return sum;
}

/* Energy, momentum and angular momentum close while a cluster breaks and its pieces collide. */
static void a_breaking_cluster_keeps_its_books(void **state)
{
    const char *const plain[] = {NULL}, *const rough[] = {"bond.damping=0.1", "contact.friction=0.5",
                                                          "bond.scatter=0.2", NULL};
    const char *const *const keys[] = {plain, rough};
    (void)state;
    for (int k = 0; k < 2; k++) {
        double residual[2];
        for (int fine = 0; fine < 2; fine++) {
            lab l;
            make_cluster(&l, 5, keys[k]);
            lab_make(&l, fine ? 2.5e-5 : 1e-4);
            assert_int_equal(l.w.discs.n, 40);
            const fl_vec3 L = angular_momentum(&l.w);
            assert_int_equal(lab_run(&l, fine ? 8000 : 2000), 0);
            const fl_bond_counts n = fl_bond_list_counts(&l.w);
            assert_true(n.state[FL_BOND_ENDED] > 10 && n.state[FL_BOND_ENDED] < 40);
            fl_energy_update(&l.w);
            residual[fine] = fabs(l.w.ledger.residual) / l.w.ledger.throughput;
            assert_near_of(v3_norm(v3_sub(angular_momentum(&l.w), L)), 0, 1e-9, v3_norm(L) + 1.0);
            assert_near_of(v3_norm(l.w.imbalance), 0, 1e-12, l.w.impulse_sum);
            lab_free(&l);
        }
        /* at the step of 1e-4 s, 0.15 of the critical one, and a quarter of it */
        assert_true(residual[0] < 1e-3 && residual[1] < 1e-4);
    }
}

/* A sphere that leaves takes its bond and the energy in it. */
/* A chain of three spheres that goes towards a free bound. */
static void chain_at_free_bound(lab *l)
{
    fl_err err = {0};
    lab_start(l);
    lab_set(l, "bond.on=true");
    lab_set(l, "bond.normal_strength=none");
    lab_set(l, "bond.shear_strength=none");
    lab_set(l, "boundary.type=free rigid rigid");
    lab_set(l, "boundary.min=-9 none none");
    lab_set(l, "boundary.max=1.02 none none");
    for (int k = 0; k < 3; k++) lab_sphere(l, v3(k - 1.1, 0, 0), 0.5, v3(4, 0.01 * k, 0), ZERO);
    for (int k = 0; k < 2; k++)
        assert_int_equal(fl_ice_field_add_bond(&l->field, k, k + 1, 0.7, 1.0, v3(k - 0.6, 0, 0), &err), 0);
    lab_make(l, 0);
}

static void a_sphere_that_leaves_loses_its_bond(void **state)
{
    lab l;
    (void)state;
    chain_at_free_bound(&l);
    for (int k = 0; k < 20000 && l.w.inflow.n_left == 0; k++) assert_int_equal(lab_run(&l, 1), 0);
    assert_int_equal(l.w.inflow.n_left, 1);
    assert_int_equal(l.w.discs.has_ended[1], FL_DISC_ENDED);
    assert_int_equal(l.w.discs.has_ended[0], FL_DISC_STANDS);
    assert_int_equal(lab_run(&l, 50), 0);
    fl_energy_update(&l.w);
    assert_near_of(l.w.ledger.residual, 0, 1e-4, l.w.ledger.throughput);
    lab_free(&l);
}

/* A bond whose sphere leaves in the step of its end has no contact after it. */
static void a_bond_that_ends_as_its_sphere_leaves_gets_no_contact(void **state)
{
    fl_err err = {0};
    lab l;
    (void)state;
    chain_at_free_bound(&l);
    assert_int_equal(lab_run(&l, 3), 0);
    fl_disc_list *const s = &l.w.discs;
    s->has_ended[1] = FL_DISC_JUST_ENDED, s->at.is_whole[1] = 0, s->pending[1] = 7.0, s->ended++;
    l.w.b.x[2].x = 9.0;
    assert_int_equal(fl_inflow_step(&l.w, &err), 0);
    assert_int_equal(l.w.inflow.n_left, 1);
    assert_int_equal(s->ended, 0);
    assert_int_equal(s->has_ended[1], FL_DISC_ENDED);
    assert_true(s->pending[1] == 0.0);
    assert_int_equal(lab_run(&l, 3), 0);
    for (int32_t c = 0; c < l.w.spheres.n; c++) assert_true(l.w.spheres.i[c] != 2 && l.w.spheres.j[c] != 2);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(springs_are_those_of_a_beam),
        cmocka_unit_test(strengths_are_those_of_the_rim),
        cmocka_unit_test(softening_takes_the_fracture_energy),
        cmocka_unit_test(shear_falls_to_friction),
        cmocka_unit_test(a_rigid_motion_changes_nothing),
        cmocka_unit_test(lanes_have_the_bits_of_one),
        cmocka_unit_test(a_breaking_cluster_keeps_its_books),
        cmocka_unit_test(a_sphere_that_leaves_loses_its_bond),
        cmocka_unit_test(a_bond_that_ends_as_its_sphere_leaves_gets_no_contact),
    };
    return cmocka_run_group_tests_name("disc", tests, NULL, NULL);
}
