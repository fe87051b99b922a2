/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdio.h>
#include <stdlib.h>
#include "base/pi.h"
#include "base/rng.h"
#include "ice/sphere_packing.h"
#include "support/scenes.h"
#include "support/shapes.h"

static fl_vec3 normal3(fl_rng *g)
{
    fl_vec3 x;
    x.x = fl_rng_normal(g);
    x.y = fl_rng_normal(g);
    x.z = fl_rng_normal(g);
    return x;
}

static void add_body(lab *l, int32_t side, int32_t k)
{
    static const char *const GROUP[] = {NULL, NULL,    NULL, NULL, "towed", NULL,
                                        NULL, "stiff", NULL, NULL, NULL};
    fl_rng g = fl_rng_of(5, k, FL_RNG_TEST);
    fl_err err = {0};
    fl_poly p = {0};
    const double middle = 0.5 * (side - 1), r = k % 5 == 0 ? 0.45 : 0.05;
    const fl_vec3 cell = v3(k % side - middle, k / side % side - middle, k / (side * side) - middle);
    const fl_vec3 v = normal3(&g), w = normal3(&g), turn = normal3(&g);
    const fl_vec3 end[2] = {v3(-0.4, 0, 0), v3(0.4, 0, 0)};
    int bad = 0;
    switch (k % 5) {
    case 0: bad = fl_poly_make(&p, 1, end, 0, NULL, NULL, &err); break;
    case 1: bad = fl_poly_make(&p, 2, end, 0, NULL, NULL, &err); break;
    case 2: shape_regular(&p, 8, 0.5); break;
    default: bad = fl_poly_box(&p, v3(fl_rng_in(&g, 0.36, 0.42), fl_rng_in(&g, 0.36, 0.42), 0.42), &err);
    }
    shape_move(&p, q_of_vector(v3_scale(0.05, turn)), cell);
    if (bad || fl_ice_field_add(&l->field, k + 1, r, &p, NULL, GROUP[k % 11],
                                v3_add(v3_scale(0.3, v), v3_scale(-0.3, cell)), v3_scale(0.3, w), &err)) {
        printf("scene_of_everything: %s\n", err.text);
        exit(1);
    }
}

void scene_of_everything(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"material.ice.young=1 MPa",
                                       "contact.friction=0.3",
                                       "contact.restitution=0.4",
                                       "run.gravity=9.81",
                                       "boundary.type=rigid elastic rigid",
                                       "boundary.foundation=50 kN/m3",
                                       "water.current=0.5 0.1 0",
                                       "wind.velocity=8 0 0",
                                       "structure.velocity=0.2 0 0",
                                       "group.towed.fixed=x ry",
                                       "part.part_2.free=x z rx rz",
                                       "part.part_2.mass=200",
                                       "part.part_2.inertia=50 0 30",
                                       "part.part_2.stiffness=1e4 0 2e4",
                                       "part.part_2.turn_stiffness=1e3 0 1e3",
                                       "part.part_2.damping=100 0 200",
                                       "part.part_2.turn_damping=20 0 10",
                                       "part.part_2.velocity=0 0.1 -0.1",
                                       "output.panels=panels",
                                       "output.events=events",
                                       "part.part_3.spin=0 0 -0.2",
                                       "part.part_3.velocity=0 0 -0.1",
                                       "group.towed.velocity=0.3 0 0",
                                       "group.stiff.fixed=rx rz"};
    const double half = 0.5 * side + 0.05, top = half + 0.02;
    const fl_vec3 hook[6] = {v3(-half, 0.3, 0), v3(-0.5, 0.3, 0), v3(-0.5, half, 0),
                             v3(-0.9, half, 0), v3(-0.9, 0.7, 0), v3(-half, 0.7, 0)};
    lab_start(l);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    lab_set(l, "boundary.damping=1 kN.s/m3");
    lab_setf(l, "boundary.min=%.17g %.17g %.17g", -half, -half, -half);
    lab_setf(l, "boundary.max=%.17g %.17g none", half, half);
    lab_wall(l, v3(-0.4, -0.9, half - 0.1), v3(0.4, -0.1, half + 1.0), 2);
    lab_cone(l, (fl_cone){v3(half - 0.7, half - 0.7, half - 0.1), v3(half - 0.7, half - 0.7, top + 1.0), 0.5,
                          0.3});
    lab_prism(l, 6, hook, half - 0.1, top + 0.5); /* not convex: a shell */
    for (int32_t k = 0; k < side * side * side; k++) add_body(l, side, k);
}

void scene_of_periodic_cell(lab *l, int32_t side, const char *law)
{
    scene_of_everything(l, side, law);
    lab_set(l, "boundary.type=periodic periodic rigid");
}

void scene_of_spheres(lab *l, int32_t side, const char *law)
{
    const double half = 0.5 * side, middle = 0.5 * (side - 1);
    lab_start(l);
    lab_set(l, "material.ice.young=1 MPa");
    lab_set(l, "contact.friction=0.3");
    lab_set(l, "contact.rolling=0.1");
    lab_set(l, "contact.restitution=0.4");
    lab_set(l, "run.gravity=9.81");
    lab_set(l, "boundary.type=periodic periodic rigid");
    if (law) lab_setf(l, "contact.law=%s", law);
    lab_setf(l, "boundary.min=%.17g %.17g %.17g", -half, -half, -half);
    lab_setf(l, "boundary.max=%.17g %.17g none", half, half);
    for (int32_t k = 0; k < side * side * side; k++) {
        fl_rng g = fl_rng_of(6, k, FL_RNG_TEST);
        const fl_vec3 cell = v3(k % side - middle, k / side % side - middle, k / (side * side) - middle);
        const fl_vec3 v = v3_scale(0.3, normal3(&g)), spin = v3_scale(0.5, normal3(&g));
        if (k % 9 == 4) lab_box(l, cell, v3(0.45, 0.45, 0.45), 0.05, q_of_vector(spin), v, spin);
        else lab_sphere(l, cell, k % 2 ? 0.52 : 0.47, v, spin);
    }
}

/* The bodies next to k with larger numbers, along x, y and z; along x the last one neighbours the first. */
static void bond_neighbours(lab *l, int32_t side, int32_t k, fl_vec3 cell)
{
    const int32_t wide = side + 1, x = k % wide, y = k / wide % side, z = k / (wide * side);
    const int32_t next[3] = {x + 1 < wide ? k + 1 : k + 1 - wide, y + 1 < side ? k + wide : -1,
                             z + 2 < side ? k + wide * side : -1};
    fl_err err = {0};
    for (int e = 0; e < 3; e++) {
        if (next[e] < 0) continue;
        const int round = k % 7 == 3 || next[e] % 7 == 3;
        const fl_vec3 at = v3_add(cell, v3(e == 0 ? 0.5 : 0.0, e == 1 ? 0.5 : 0.0, e == 2 ? 0.5 : 0.0));
        if (fl_ice_field_add_bond(&l->field, k, next[e], round ? 0.7 : 1.0, 1.0, at, &err)) exit(1);
    }
}

void scene_of_bonds(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"material.ice.young=10 MPa",
                                       "contact.friction=0.3",
                                       "contact.restitution=0.4",
                                       "run.gravity=9.81",
                                       "bond.on=true",
                                       "bond.normal_strength=10 kPa",
                                       "bond.energy=8",
                                       "bond.shear_strength=12 kPa",
                                       "bond.shear_energy=10",
                                       "bond.damping=0.02",
                                       "group.towed.fixed=x ry",
                                       "group.towed.velocity=0.3 0 0"};
    const int32_t row = side + 1;
    const double wide = 0.5 * row, half = 0.5 * side;
    lab_start(l);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    lab_set(l, "boundary.type=periodic rigid rigid");
    lab_setf(l, "boundary.min=%.17g %.17g %.17g", -wide, -half - 0.01, -half + 0.001);
    lab_setf(l, "boundary.max=%.17g %.17g none", wide, half + 0.01);
    for (int32_t k = 0; k < row * side * (side - 1); k++) {
        fl_rng g = fl_rng_of(7, k, FL_RNG_TEST);
        fl_err err = {0};
        fl_poly p = {0};
        const fl_vec3 cell =
            v3(k % row - wide + 0.5, k / row % side - half + 0.5, k / (row * side) - half + 0.5);
        const fl_vec3 v = v3_scale(0.4, normal3(&g)), spin = v3_scale(0.4, normal3(&g)), none = v3(0, 0, 0);
        const int round = k % 7 == 3;
        if ((round ? fl_poly_make(&p, 1, &none, 0, NULL, NULL, &err)
                   : fl_poly_box(&p, v3(0.45, 0.45, 0.45), &err)))
            exit(1);
        shape_move(&p, q_one(), cell);
        if (fl_ice_field_add(&l->field, k + 1, round ? 0.5 : 0.05, &p, NULL, k % 11 == 5 ? "towed" : NULL, v,
                             spin, &err))
            exit(1);
        bond_neighbours(l, side, k, cell);
    }
}

static const char *base_group(int32_t k, int32_t side) { return k < side * side ? "base" : NULL; }

/* A block above, one that deforms, and the base. */
static const char *stage_group(int32_t k, int32_t side)
{
    if (k < side * side) return "base";
    if (k == side * side * side - 1) return "above";
    if (k == side * side * (side - 1)) return "beside";
    return k % 3 ? "soft" : NULL;
}

static void jointed_blocks(lab *l, int32_t side, const char *law,
                           const char *(*group_of)(int32_t k, int32_t side))
{
    static const char *const KEYS[] = {"material.ice.young=10 MPa",
                                       "run.gravity=9.81",
                                       "contact.friction=0.3",
                                       "group.base.fixed=x y z rx ry rz",
                                       "joint.bed.normal_stiffness=1e7",
                                       "joint.bed.shear_stiffness=5e6",
                                       "joint.bed.friction_angle=20",
                                       "joint.bed.cohesion=2 kPa",
                                       "joint.bed.tension=1 kPa",
                                       "joint.bed.dilation=5",
                                       "joint.bed.damping=0.05",
                                       "joint.bed.water_pressure=200",
                                       "joint.wall.law=yielding",
                                       "joint.wall.normal_stiffness=1e7",
                                       "joint.wall.shear_stiffness=100",
                                       "joint.wall.shear_exponent=1",
                                       "joint.wall.largest_shear_stiffness=1e7",
                                       "joint.wall.friction_angle=20",
                                       "joint.wall.initial_angle=40",
                                       "joint.wall.roughness=0.01",
                                       "joint.wall.initial_stress=0 5e3 0"};
    static const char *const NAME[3] = {"bed", "wall", "intact"};
    static const int32_t FACE[3][2] = {{3, 5}, {4, 2}, {1, 0}};
    fl_err err = {0};
    lab_start(l);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    for (int32_t k = 0; k < side * side * side; k++) {
        static const fl_vec3 SQUARE[4] = {
            {-0.45, -0.45, 0}, {0.45, -0.45, 0}, {0.45, 0.45, 0}, {-0.45, 0.45, 0}};
        fl_rng g = fl_rng_of(9, k, FL_RNG_TEST);
        const int32_t cell[3] = {k % side, k / side % side, k / (side * side)},
                      step[3] = {1, side, side * side};
        const fl_vec3 v = v3_scale(0.3, normal3(&g)), spin = v3_scale(0.2, normal3(&g));
        fl_poly p = {0};
        if (fl_poly_prism(&p, 4, SQUARE, -0.45, 0.45, &err)) exit(1);
        shape_move(&p, q_one(), v3(cell[0], cell[1], cell[2]));
        if (fl_ice_field_add(&l->field, k, 0.05, &p, NULL, group_of(k, side), cell[2] ? v : v3(0, 0, 0),
                             cell[2] ? spin : v3(0, 0, 0), &err))
            exit(1);
        for (int e = 0; e < 3; e++)
            if (cell[e] + 1 < side &&
                fl_ice_field_add_joint(&l->field, k, k + step[e], FACE[e][0], FACE[e][1],
                                       NAME[e == 2 && cell[2] == 0 ? 0 : e], &err))
                exit(1);
    }
}

void scene_of_joints(lab *l, int32_t side, const char *law) { jointed_blocks(l, side, law, base_group); }

void scene_of_stages(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"stage.a.remove=above", "stage.b.start=0.02", "stage.c.remove=beside"};
    jointed_blocks(l, side, law, stage_group);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
}

void scene_of_seas(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {
        "water.drag=facet", "water.profile=linear",     "water.profile_depth=2", "water.added_mass=auto",
        "wind.drag=facet",  "water.added_inertia=auto", "water.wave=jonswap",    "water.height=0.3",
        "water.period=5",   "water.components=8"};
    scene_of_everything(l, side, law);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
}

void scene_of_water_interval(lab *l, int32_t side, const char *law)
{
    scene_of_everything(l, side, law);
    lab_set(l, "water.every=4");
    lab_set(l, "water.profile=linear");
    lab_set(l, "water.profile_depth=2");
}

void scene_of_surrogates(lab *l, int32_t side, const char *law)
{
    scene_of_everything(l, side, law);
    lab_set(l, "contact.surrogate=0.01");
}

void scene_of_sea_interval(lab *l, int32_t side, const char *law)
{
    scene_of_seas(l, side, law);
    lab_set(l, "water.every=7");
}

void scene_of_inflow(lab *l, int32_t side, const char *law)
{
    const double half = 0.5 * side - 0.4;
    scene_of_everything(l, side, law);
    lab_set(l, "boundary.type=free elastic rigid");
    lab_setf(l, "boundary.min=%.17g %.17g %.17g", -half - 2.5, -half - 0.45, -half - 0.45);
    lab_setf(l, "boundary.max=%.17g %.17g none", half - 0.85, half + 0.45);
    lab_set(l, "boundary.inflow=ice");
    lab_set(l, "boundary.inflow_speed=20 m/s");
    lab_set(l, "boundary.drive=0.5 0 0");
    lab_set(l, "boundary.drive_width=0.7");
    lab_set(l, "boundary.drive_fixed=x rz"); /* and some of them are held in y */
    lab_set(l, "group.towed.fixed=y ry"), lab_set(l, "group.towed.velocity=0 0.3 0");
    lab_set(l, "boundary.drive_foundation=1 kN/m3");
}

void scene_of_inflow_interval(lab *l, int32_t side, const char *law)
{
    scene_of_inflow(l, side, law);
    lab_set(l, "water.wave=airy"), lab_set(l, "water.height=0.1"), lab_set(l, "water.period=5");
    lab_set(l, "water.every=5");
}

void scene_of_pushed_ice(lab *l, int32_t side, const char *law)
{
    scene_of_inflow(l, side, law);
    lab_set(l, "boundary.drive_width=none"), lab_set(l, "boundary.drive=0");
    lab_set(l, "boundary.line_load=200 N/m");
}

void scene_of_joined_parts(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"material.ice.young=10 MPa", "contact.friction=0.3",
                                       "contact.restitution=0.4", "contact.surrogate=0.01",
                                       "run.gravity=9.81"};
    const double half = 0.5 * side + 1.0, low = -0.5 * (side - 1) - 0.368;
    lab_start(l);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    lab_wall(l, v3(-half, -half, low - 1.0), v3(0.3, half, low), 2);
    lab_wall(l, v3(0.3, -half, low - 1.0), v3(half, half, low), 1);
    lab_cone(l, (fl_cone){v3(half - 0.78, 0.1, low - 1.0), v3(half - 0.78, 0.1, low + 0.5), 0.2, 0.2});
    lab_cone(l, (fl_cone){v3(half - 0.78, 0.1, low + 0.5), v3(half - 0.78, 0.1, low + side + 2.0), 0.2, 0.1});
    for (int32_t k = 0; k < side * side * side; k++) {
        fl_rng g = fl_rng_of(9, k, FL_RNG_TEST);
        const double middle = 0.5 * (side - 1);
        const fl_vec3 cell = v3(k % side - middle, k / side % side - middle, k / (side * side) - middle),
                      v = v3_scale(0.4, normal3(&g)), spin = v3_scale(0.4, normal3(&g));
        if (k % 5 == 3) lab_sphere(l, cell, 0.4, v, spin);
        else
            lab_box(l, cell, v3(0.37, 0.37, 0.37), 0.05, k < side * side ? q_one() : q_of_vector(spin), v,
                    spin);
    }
}

void scene_of_failing_floes(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"material.ice.young=20 MPa",
                                       "contact.friction=0.2",
                                       "contact.restitution=0.4",
                                       "run.gravity=9.81",
                                       "water.density=1000",
                                       "failure.crushing=all",
                                       "failure.pressure=60 kPa",
                                       "failure.flexural_strength=20 kPa",
                                       "failure.fracture_toughness=2 kPa.m^0.5",
                                       "failure.fragment_min=0.02"};
    lab_start(l);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    lab_cone(l, (fl_cone){v3(0, 0, -1.0), v3(0, 0, 0.6), 1.0, 0.2});
    lab_cone(l, (fl_cone){v3(0, 5, -1.0), v3(0, 5, 1.0), 0.4, 0.4});
    for (int32_t k = 0; k < 4 * side; k++) {
        const double angle = 2.0 * PI * k / (2 * side) + 0.1, at = k < 2 * side ? 0.0 : 5.0,
                     far = fmax(0.82, 0.31 + 0.31 / tan(0.5 * PI / side));
        const fl_vec3 out = v3(cos(angle), sin(angle), 0);
        fl_rng g = fl_rng_of(11, k, FL_RNG_TEST);
        lab_box(l, v3_add(v3(0, at, 0.01), v3_scale(far, out)), v3(0.3, 0.3, 0.05), 0.01,
                q_about_axis(2, angle), v3_scale(-8.0 - fl_rng_in(&g, 0.0, 4.0), out),
                v3(0, 0, fl_rng_in(&g, -0.2, 0.2)));
    }
}

/* A sheet of two layers with its bonds, that moves at v, each sphere up to `scatter` faster; its length. */
static double add_sheet(lab *l, int32_t side, double v, double scatter)
{
    const double r = 0.1, long_side = 4.01 * r * side, wide = 6.01 * r * side;
    fl_sphere_packing a;
    fl_err err = {0};
    if (fl_sphere_packing_make(&a, FL_PACKING_HCP, 2.0 * r, 2, (fl_vec2){-long_side, -0.5 * wide},
                               (fl_vec2){0.0, 0.5 * wide}, &err))
        exit(1);
    const double draft = fl_sphere_packing_draft(&a, 900.0 / 1025.0), length = 2.0 * r * a.columns;
    for (int32_t k = 0; k < a.n; k++) {
        fl_rng g = fl_rng_of(8, k, FL_RNG_TEST);
        const fl_vec3 more = v3_scale(0.4 * scatter, normal3(&g)), spin = v3_scale(scatter, normal3(&g));
        lab_sphere(l, v3(a.x[k].x, a.x[k].y, a.x[k].z - draft), r, v3_add(v3(v, 0, 0), more), spin);
    }
    for (int32_t k = 0; k < a.pairs; k++) {
        const int32_t i = a.pair[k][0], j = a.pair[k][1];
        if (fl_ice_field_add_bond(&l->field, i, j, 0.03, 0.2,
                                  v3_lerp(l->field.core[i].v[0], l->field.core[j].v[0], 0.5), &err))
            exit(1);
    }
    fl_sphere_packing_free(&a);
    return length;
}

static const char *const SHEET_KEYS[] = {"material.ice.young=20 MPa",
                                         "contact.friction=0.3",
                                         "contact.restitution=0.4",
                                         "run.gravity=9.81",
                                         "ice.slab=0.33 m",
                                         "contact.round_law=linear",
                                         "bond.on=true",
                                         "bond.normal_strength=30 kPa",
                                         "bond.shear_strength=30 kPa",
                                         "bond.softening=stretch",
                                         "bond.damping=0.1",
                                         "water.density=1025",
                                         "water.added_mass=0 0 3",
                                         "boundary.type=free"};
enum { SHEET_KEY_COUNT = sizeof SHEET_KEYS / sizeof *SHEET_KEYS };

void scene_of_sheet(lab *l, int32_t side, const char *law)
{
    static const char *const KEYS[] = {"water.current=1 0 0", "boundary.drive=1 0 0",
                                       "boundary.drive_width=0.15", "boundary.drive_fixed=x y rx rz",
                                       "boundary.drive_foundation=10 kN/m3"};
    lab_start(l);
    for (size_t k = 0; k < SHEET_KEY_COUNT; k++) lab_set(l, SHEET_KEYS[k]);
    for (size_t k = 0; k < sizeof KEYS / sizeof *KEYS; k++) lab_set(l, KEYS[k]);
    if (law) lab_setf(l, "contact.law=%s", law);
    add_sheet(l, side, 1.0, 1.0);
    lab_cone(l, (fl_cone){.p0 = v3(0.85, 0, -0.6), .p1 = v3(0.85, 0, 0.6), .r0 = 0.9, .r1 = 0.3});
}

void scene_of_endless_sheet(lab *l, int32_t side, const char *law)
{
    double front = -INFINITY;
    lab_start(l);
    for (size_t k = 0; k < SHEET_KEY_COUNT; k++) lab_set(l, SHEET_KEYS[k]);
    lab_set(l, "water.current=8 0 0");
    if (law) lab_setf(l, "contact.law=%s", law);
    const double pitch = add_sheet(l, side, 8.0, 0.0);
    for (int32_t k = 0; k < l->field.n; k++)
        front = fmax(front, l->field.core[k].v[0].x + l->field.radius[k]);
    lab_setf(l, "boundary.min=%.17g none none", front - pitch), lab_set(l, "boundary.max=-0.15 none none");
    lab_set(l, "boundary.inflow=ice"), lab_setf(l, "boundary.inflow_pitch=%.17g", pitch);
    lab_cone(l, (fl_cone){.p0 = v3(0.74, 0, -0.6), .p1 = v3(0.74, 0, 0.6), .r0 = 0.9, .r1 = 0.3});
}
