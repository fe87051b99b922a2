/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Motion of structure parts as given by the sections of the scene. */
#include "sim/setup.h"
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "scene/scene_check.h"
#include "sim/critical_step.h"
#include "sim/moving_structure.h"
#include "support/small_world.h"

static const fl_vec3 ZERO = {0, 0, 0};

static void make_three_parts(lab *l)
{
    lab_start(l);
    lab_sphere(l, v3(100, 0, 0), 0.1, ZERO, ZERO);
    lab_wall(l, v3(-1, -1, -1), v3(1, 1, 1), 1);
    lab_cone(l, (fl_cone){v3(4, 0, -1), v3(4, 0, 1), 0.5, 0.5});
    lab_cone(l, (fl_cone){v3(8, 0, -1), v3(8, 0, 1), 0.5, 0.5});
}

static void fixed_parts_have_no_motion(void **state)
{
    lab l;
    (void)state;
    make_three_parts(&l);
    lab_make(&l, 1e-3);
    assert_int_equal(l.w.moving.movers.n, 0);
    assert_null(l.w.moving.mover_of_piece);
    assert_int_equal(fl_motion_columns(&l.w), FL_LOADS_FIXED);
    lab_free(&l);
}

static void each_part_moves_as_its_section_says(void **state)
{
    lab l;
    fl_loads_motion m;
    (void)state;
    make_three_parts(&l);
    lab_set(&l, "structure.velocity=1 0 0");
    lab_set(&l, "part.part_2.velocity=0 2 0");
    lab_set(&l, "part.part_3.reference=8 0 0"); /* no other part moves */
    lab_make(&l, 1e-3);
    assert_int_equal(l.w.moving.movers.n, 2);
    assert_int_equal(fl_motion_columns(&l.w), FL_LOADS_TRANSLATION);
    lab_run(&l, 500);
    assert_near(l.w.b.x[1].x, 0.5, 1e-12);
    assert_near(l.w.b.x[2].y, 1.0, 1e-12);
    assert_near(l.w.b.x[3].x, 8.0, 0);
    fl_part_motion(&l.w, 1, 0.5, &m);
    assert_near(m.u.y, 1.0, 1e-12);
    assert_near(m.v.y, 2.0, 1e-15);
    fl_part_motion(&l.w, 2, 0.5, &m);
    assert_near(m.u.y, 0, 0);
    assert_near(l.w.part_reference[2].x, 8.0, 0);
    assert_near(l.w.part_reference[0].x, 0.5, 1e-12);
    lab_free(&l);
}

/* The moment on a rotating part is taken about its reference point at its current position. */
static void columns_hold_rotation_and_acceleration(void **state)
{
    lab l;
    fl_loads_motion m;
    (void)state;
    make_three_parts(&l);
    lab_set(&l, "structure.spin=0 0 2");
    lab_set(&l, "part.part_2.free=x");
    lab_set(&l, "part.part_2.mass=2");
    lab_set(&l, "part.part_2.stiffness=8 0 0");
    lab_set(&l, "part.part_2.damping=1 0 0");
    lab_make(&l, 1e-3);
    assert_int_equal(fl_motion_columns(&l.w), FL_LOADS_ROTATION);
    l.w.moving.movers.b.x[1].x = 0.5; /* from its reference point, the origin */
    lab_run(&l, 1);
    fl_part_motion(&l.w, 1, 1e-3, &m);
    assert_near(m.a.x, (-8 * m.u.x - m.v.x) / 2, 1e-13);
    lab_run(&l, 499);
    fl_part_motion(&l.w, 0, 0.5, &m);
    assert_near(m.r.z, 1.0, 1e-13);
    assert_near(m.w.z, 2.0, 1e-14);
    assert_near_of(m.e.z, 0, 1e-9, 1.0);
    lab_free(&l);
}

static void mass_and_springs_limit_the_step(void **state)
{
    double dt[2];
    int32_t body = -1;
    (void)state;
    for (int k = 0; k < 2; k++) {
        lab l;
        make_three_parts(&l);
        lab_set(&l, "part.part_2.free=x");
        lab_set(&l, "part.part_2.mass=1000");
        lab_setf(&l, "part.part_2.stiffness=%g 0 0", k ? 1e13 : 1e3);
        lab_make(&l, 0);
        dt[k] = fl_automatic_step(&l.w, &body);
        if (k) {
            assert_int_equal(body, l.w.b.total);
            assert_string_equal(fl_mover_name(&l.w, 0), "part_2");
        }
        lab_free(&l);
    }
    assert_true(dt[1] < 0.1 * dt[0]);
    assert_near(dt[1], 0.1 * 2.0 / sqrt(1e13 / 1000), 1e-2);
}

/* A floating box with an additional spring. */
static void added_mass_counts_in_critical_damping(void **state)
{
    const double D = 0.05, m = 1025.0 * 2 * 2 * 1, k = 3e4;
    lab l;
    (void)state;
    lab_start(&l);
    lab_sphere(&l, v3(100, 0, 0), 0.1, ZERO, ZERO);
    lab_wall(&l, v3(-1, -1, -1), v3(1, 1, 1), 1);
    lab_set(&l, "water.density=1025");
    lab_set(&l, "run.gravity=9.81");
    lab_set(&l, "structure.free=z");
    lab_setf(&l, "structure.mass=%.17g", m);
    lab_setf(&l, "structure.stiffness=0 0 %.17g", k);
    lab_setf(&l, "structure.damping_ratio=0 0 %.17g", D);
    lab_set(&l, "structure.hydrostatic=mesh");
    lab_make(&l, 1e-3);
    assert_near(l.w.moving.movers.motion[0].c.z, 2 * D * sqrt((k + 1025 * 9.81 * 4) * m), 1e-13);
    lab_free(&l);
}

/* The sentences of structure.waves that need a sea. */
static void invalid_waves_are_reported(void **state)
{
    static const struct {
        const char *set[2], *message;
    } wrong[] = {
        {{"structure.hydrostatic=mesh"}, "hydrostatic = none is expected"},
        {{"structure.period=0 0 1"}, "period: hydrostatic stiffness acts along z as well"},
        {{"structure.added_mass=0 0 -1"}, "added_mass: a value is below 0"},
        {{"structure.free=none", "structure.mass=none"}, "none is free: `free` is expected"},
        {{"structure.file=lab"}, NULL},
    };
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        lab l;
        fl_err err = {0};
        make_three_parts(&l);
        lab_set(&l, "structure.file=lab");
        lab_set(&l, "run.gravity=9.81");
        lab_set(&l, "water.wave=airy");
        lab_set(&l, "water.height=1");
        lab_set(&l, "water.period=8");
        lab_set(&l, "structure.free=z");
        lab_set(&l, "structure.waves=mesh");
        lab_set(&l, "structure.mass=1");
        for (int s = 0; s < 2 && wrong[k].set[s]; s++) lab_set(&l, wrong[k].set[s]);
        assert_int_equal(fl_scene_check(&l.scene, &err), wrong[k].message ? -1 : 0);
        if (wrong[k].message && !strstr(err.text, wrong[k].message)) fail_msg("%s", err.text);
        lab_free(&l);
    }
}

static void invalid_motions_are_reported(void **state)
{
    static const struct {
        const char *set[4], *message;
    } wrong[] = {
        {{"structure.free=x"}, "structure.mass: free directions need a mass, and none is given"},
        {{"structure.mass=1"}, "a mass applies to free directions, and none of x y z is free"},
        {{"structure.free=rx"}, "every free rotation needs an inertia above 0"},
        {{"structure.free=x", "structure.mass=1", "structure.stiffness=0 1 0"},
         "a direction has a value that is not among the free ones"},
        {{"structure.free=x", "structure.mass=1", "structure.damping=-1 0 0"}, "a value is below 0"},
        {{"structure.free=x", "structure.mass=1", "structure.stiffness=1 0 0", "structure.period=1 0 0"},
         "stiffness is given as well, one of the two is expected"},
        {{"structure.free=x", "structure.mass=1", "structure.damping=1 0 0", "structure.damping_ratio=1 0 0"},
         "damping is given as well"},
        {{"structure.free=x y", "structure.mass=1", "structure.stiffness=1 0 0",
          "structure.damping_ratio=0.1 0.1 0"},
         "damping_ratio: a direction without a spring has no critical damping"},
        {{"structure.free=z", "structure.mass=1", "structure.period=0 0 1", "structure.hydrostatic=mesh"},
         "period: hydrostatic stiffness acts along z as well: a stiffness is expected"},
        {{"structure.free=x", "structure.mass=1", "structure.spin=0 0 1"},
         "a body with free directions has no prescribed spin"},
        {{"structure.track=a", "structure.velocity=1 0 0"}, "velocity and spin are given as well"},
        {{"structure.free=x", "structure.mass=1", "structure.hydrostatic=mesh"},
         "it applies to z, rx and ry"},
        {{"structure.free=z", "structure.mass=1", "structure.hydrostatic=mesh"}, "[water] is expected"},
        {{"structure.free=x", "structure.mass=1", "structure.coupling=1 0 0"}, "it applies to z, rx and ry"},
        {{"structure.free=x", "structure.mass=1", "structure.waves=mesh"},
         "waves: there are no waves: water.wave is expected"},
        {{"structure.free=z", "structure.mass=1", "structure.added_mass=0 0 1"},
         "added_mass: it belongs to waves = mesh"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        lab l;
        fl_err err = {0};
        make_three_parts(&l);
        lab_set(&l, "structure.file=lab");
        for (int s = 0; s < 4 && wrong[k].set[s]; s++) lab_set(&l, wrong[k].set[s]);
        assert_int_equal(fl_scene_check(&l.scene, &err), -1);
        if (!strstr(err.text, wrong[k].message)) fail_msg("%s", err.text);
        lab_free(&l);
    }
    lab l;
    fl_err err = {0};
    make_three_parts(&l);
    lab_set(&l, "structure.file=lab");
    lab_set(&l, "part.leg.velocity=1 0 0");
    assert_int_equal(fl_scene_check(&l.scene, &err), 0);
    assert_int_equal(fl_world_make(&l.w, &l.scene, &l.field, &l.surface, &err), -1);
    if (!strstr(err.text, "there is no part leg in lab")) fail_msg("%s", err.text);
    lab_free(&l);
    lab_start(&l);
    lab_sphere(&l, ZERO, 0.1, ZERO, ZERO);
    lab_set(&l, "part.leg.velocity=1 0 0");
    err = (fl_err){0};
    assert_int_equal(fl_scene_check(&l.scene, &err), -1);
    if (!strstr(err.text, "[part leg] needs a structure")) fail_msg("%s", err.text);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(fixed_parts_have_no_motion),
                                       cmocka_unit_test(each_part_moves_as_its_section_says),
                                       cmocka_unit_test(columns_hold_rotation_and_acceleration),
                                       cmocka_unit_test(mass_and_springs_limit_the_step),
                                       cmocka_unit_test(added_mass_counts_in_critical_damping),
                                       cmocka_unit_test(invalid_motions_are_reported),
                                       cmocka_unit_test(invalid_waves_are_reported)};
    return cmocka_run_group_tests_name("moving_structure", tests, NULL, NULL);
}
