/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "sim/energy_balance.h"
#include "sim/setup.h"
#include "support/near.h"
#include "body/integrate.h"
#include "scene/scene_check.h"
#include "sphere/contact_list.h"
#include "contact/bond_list.h"
#include "support/small_world.h"

static const fl_vec3 ZERO = {0, 0, 0};

static void add_bond(lab *l, int32_t i, int32_t j, double area, fl_vec3 x)
{
    fl_err err = {0};
    assert_int_equal(fl_ice_field_add_bond(&l->field, i, j, area, 1.0, x, &err), 0);
}

/* Two boxes with a common face, or two spheres that overlap from the start. */
static void make_two_bodies(lab *l, int round)
{
    lab_start(l);
    lab_set(l, "bond.on=true");
    for (int k = 0; k < 2; k++) {
        if (round) lab_sphere(l, v3(k * 0.98, 0, 0), 0.5, ZERO, ZERO);
        else lab_box(l, v3(k, 0, 0.1 * k), v3(0.5, 0.4, 0.3), 0.02, q_one(), ZERO, ZERO);
    }
    add_bond(l, 0, 1, 0.4, v3(round ? 0.49 : 0.5, 0, 0));
}

/* A bonded pair has no contact, and bodies at rest stay at rest. */
static void bonded_pairs_have_no_contact(void **state)
{
    (void)state;
    for (int round = 0; round < 2; round++) {
        lab l;
        make_two_bodies(&l, round);
        lab_make(&l, 0);
        assert_int_equal(lab_run(&l, 20), 0);
        assert_int_equal(l.w.n_pair, 0);
        assert_int_equal(l.w.spheres.n, 0);
        assert_near_of(v3_norm(l.w.b.v[0]), 0, 1e-12, 1);
        assert_near(l.w.bonds.bond[0].length, round ? 0.98 : 1.0, 1e-12);
        lab_free(&l);
        make_two_bodies(&l, round);
        lab_set(&l, "bond.on=false");
        lab_make(&l, 1e-4);
        assert_int_equal(lab_run(&l, 20), 0);
        assert_int_equal(l.w.n_pair + l.w.spheres.n, 1);
        assert_true(l.w.bonds.n == 0);
        lab_free(&l);
    }
}

/* The face is the common part of the two sides, with the area of the record; for spheres it is a disc. */
static void faces_are_those_of_the_shapes(void **state)
{
    lab l;
    (void)state;
    make_two_bodies(&l, 0);
    lab_make(&l, 0);
    const fl_bond *c = &l.w.bonds.bond[0];
    assert_near(c->area, 0.4, 0);
    assert_near(2.0 * v3_norm(c->ai), 0.5, 1e-12); /* 0.6 m high, one 0.1 m above the other */
    assert_near(2.0 * v3_norm(c->bi), 0.8, 1e-12);
    lab_free(&l);
    make_two_bodies(&l, 1);
    lab_make(&l, 0);
    c = &l.w.bonds.bond[0];
    assert_near(3.0 * 3.14159265358979 * v3_norm2(c->ai) / 4.0, 9.0 / 16.0 * 0.4, 1e-12);
    lab_free(&l);
}

/* A bonded sphere rotates its face: a spinning sphere twists the bond and swings back. */
static void bonded_spheres_turn(void **state)
{
    lab l;
    (void)state;
    make_two_bodies(&l, 1);
    lab_set(&l, "bond.normal_strength=none");
    lab_set(&l, "bond.shear_strength=none");
    lab_make(&l, 0);
    fl_body_set_spin(&l.w.b, 1, v3(0.3, 0, 0));
    fl_err err = {0};
    assert_int_equal(fl_step_start(&l.w, &err), 0);
    double largest = 0.0;
    for (int k = 0; k < 2000; k++) {
        assert_int_equal(lab_run(&l, 1), 0);
        largest = fmax(largest, l.w.b.w[0].x);
    }
    assert_near(largest, 0.3, 1e-3); /* equal bodies exchange the spin */
    fl_energy_update(&l.w);
    assert_near_of(l.w.ledger.residual, 0, 1e-3, l.w.ledger.throughput);
    lab_free(&l);
}

/* A floe that leaves takes its bonds with it, and the energy ledger accounts for them. */
static void a_floe_that_leaves_loses_its_bonds(void **state)
{
    lab l;
    (void)state;
    lab_start(&l);
    lab_set(&l, "bond.on=true");
    lab_set(&l, "boundary.type=free rigid rigid");
    lab_set(&l, "boundary.min=-9 none none");
    lab_set(&l, "boundary.max=1.02 none none");
    for (int k = 0; k < 3; k++)
        lab_box(&l, v3(k - 0.5, 0, 0), v3(0.5, 0.4, 0.3), 0.02, q_one(), v3(4, 0.01 * k, 0), ZERO);
    add_bond(&l, 0, 1, 0.48, v3(0, 0, 0));
    add_bond(&l, 1, 2, 0.48, v3(1, 0, 0));
    lab_make(&l, 0);
    for (int k = 0; k < 4000 && l.w.inflow.n_left == 0; k++) assert_int_equal(lab_run(&l, 1), 0);
    assert_int_equal(l.w.inflow.n_left, 1);
    assert_int_equal(l.w.bonds.bond[1].state, FL_BOND_ENDED);
    assert_true(l.w.bonds.bond[0].state != FL_BOND_ENDED);
    assert_int_equal(lab_run(&l, 50), 0);
    fl_energy_update(&l.w);
    assert_near_of(l.w.ledger.residual, 0, 1e-4, l.w.ledger.throughput);
    lab_free(&l);
}

/* Bonds alone limit the step: for two bodies on one face omega^2 is at most that of the face's springs. */
static void bonds_limit_the_step(void **state)
{
    lab l;
    (void)state;
    make_two_bodies(&l, 0);
    lab_make(&l, 0);
    const fl_bond *c = &l.w.bonds.bond[0];
    const double lower_bound = c->kn * c->area * 2.0 * l.w.b.invm[0];
    assert_true(fl_bond_list_omega2(&l.w, 0) >= lower_bound);
    assert_true(fl_bond_list_omega2(&l.w, 0) < 20.0 * lower_bound);
    assert_near(fl_bond_list_max_omega2(&l.w, 0), fl_bond_list_omega2(&l.w, 0), 1e-9);
    assert_true(l.w.dt < 2.0 / sqrt(fl_bond_list_omega2(&l.w, 0)));
    fl_bond_end(&l.w.bonds.bond[0]);
    assert_near(fl_bond_list_omega2(&l.w, 0), 0, 0);
    lab_free(&l);
}

static void invalid_bonds_are_refused(void **state)
{
    lab l;
    fl_err err = {0};
    (void)state;
    lab_start(&l);
    lab_set(&l, "bond.on=true");
    lab_sphere(&l, ZERO, 0.5, ZERO, ZERO);
    assert_int_equal(fl_scene_check(&l.scene, &err), 0);
    assert_int_equal(fl_world_make(&l.w, &l.scene, &l.field, NULL, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(
        strstr(err.text, "no bond in it, and [bond] is on: a field of voronoi-ice --bonded is expected"));
    err = (fl_err){0};
    lab_sphere(&l, ZERO, 0.5, ZERO, ZERO);
    add_bond(&l, 0, 1, 0.4, ZERO);
    assert_int_equal(fl_world_make(&l.w, &l.scene, &l.field, NULL, &err), -1);
    assert_non_null(strstr(err.text, "has no length: their centres are 0 m apart across it"));
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bonded_pairs_have_no_contact), cmocka_unit_test(faces_are_those_of_the_shapes),
        cmocka_unit_test(bonded_spheres_turn),          cmocka_unit_test(a_floe_that_leaves_loses_its_bonds),
        cmocka_unit_test(bonds_limit_the_step),         cmocka_unit_test(invalid_bonds_are_refused),
    };
    return cmocka_run_group_tests_name("bond_list", tests, NULL, NULL);
}
