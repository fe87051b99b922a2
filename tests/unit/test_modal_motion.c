/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Structures that vibrate in modes. */
#include "structure/modal_motion.h"
#include "support/near.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include "base/pi.h"
#include "scene/scene_check.h"
#include "sim/energy_balance.h"
#include "sim/moving_structure.h"
#include "support/small_world.h"

static const fl_vec3 ZERO = {0, 0, 0};

/* A floe hits a pile. */
static void hit_pile(lab *l)
{
    lab_start(l);
    lab_set(l, "contact.restitution=0.3");
    lab_set(l, "contact.friction=0.2");
    lab_set(l, "contact.stiffness_factor=0.01");
    lab_cone(l, (fl_cone){v3(0, 0, -2), v3(0, 0, 2), 1, 1});
    lab_box(l, v3(-4.1, 0.3, 0), v3(3, 2, 0.25), 0.05, q_one(), v3(0.5, 0, 0), ZERO);
}

static void one_mode_is_the_motion_of_a_spring(void **state)
{
    lab a, b;
    (void)state;
    hit_pile(&a);
    lab_set(&a, "structure.free=x y");
    lab_set(&a, "structure.mass=5000");
    lab_set(&a, "structure.period=0.5 0.5 0");
    lab_set(&a, "structure.damping_ratio=0.02 0.02 0");
    lab_make(&a, 2e-4);
    hit_pile(&b);
    lab_set(&b, "mode bend.mass=20000");
    lab_set(&b, "mode bend.shape=2");
    lab_set(&b, "mode bend.frequency=2");
    lab_set(&b, "mode bend.damping_ratio=0.02");
    lab_set(&b, "mode bend.direction=xy");
    lab_make(&b, 2e-4);
    assert_int_equal(fl_structure_modes(&b.w), 2);
    assert_int_equal(lab_run(&a, 10000), 0);
    assert_int_equal(lab_run(&b, 10000), 0);
    const fl_vec3 x = a.w.moving.movers.b.x[0], y = b.w.moving.movers.b.x[0];
    assert_true(fabs(x.x) > 1e-4);
    assert_near(y.x, x.x, 1e-9);
    assert_near(y.y, x.y, 1e-9);
    fl_energy_update(&a.w);
    fl_energy_update(&b.w);
    assert_near(b.w.ledger.spring, a.w.ledger.spring, 1e-9);
    assert_near(b.w.ledger.damper, a.w.ledger.damper, 1e-9);
    assert_near(b.w.ledger.structure, a.w.ledger.structure, 1e-9);
    lab_free(&a);
    lab_free(&b);
}

/* Two modes under a load: the first moves as if alone, and the waterline is their sum. */
static void modes_add_up_at_the_waterline(void **state)
{
    fl_modal_dof m[2] = {{.e = {1, 0, 0}, .mass = 2.0, .omega = 3.0, .ratio = 0.1},
                         {.e = {0.6, 0.8, 0}, .mass = 5.0, .omega = 7.0, .ratio = 0.0}};
    const double dt = 1e-4;
    (void)state;
    fl_modes_set_step(m, 2, dt);
    fl_modes_load(m, 2, v3(4, 1, 0));
    for (int k = 0; k < 20000; k++) {
        fl_modes_damp(m, 2);
        fl_modes_kick(m, 2, 0.5 * dt);
        fl_modes_drift(m, 2, dt);
        fl_modes_load(m, 2, v3(4, 1, 0));
        fl_modes_kick(m, 2, 0.5 * dt);
        fl_modes_damp(m, 2);
    }
    /* step response 1 - exp(-zw t)(cos + zw/wd sin) of either */
    const double t = 2.0, wd = 3.0 * sqrt(1 - 0.01),
                 q = 4.0 / 18.0 * (1 - exp(-0.3 * t) * (cos(wd * t) + 0.3 / wd * sin(wd * t))),
                 p = (0.6 * 4 + 0.8) / 245.0 * (1 - cos(7 * t));
    assert_near(m[0].q, q, 1e-6);
    assert_near(m[1].q, p, 1e-6);
    assert_near(fl_modes_displacement(m, 2).x, m[0].q + 0.6 * m[1].q, 1e-15);
    assert_near(fl_modes_displacement(m, 2).y, 0.8 * m[1].q, 1e-15);
    /* energy: work of the load less the damper's */
    const double work = 4.0 * m[0].q + (0.6 * 4 + 0.8) * m[1].q;
    assert_near(fl_mode_energy(&m[0]) + fl_mode_energy(&m[1]) + m[0].damped, work, 1e-6);
    assert_true(fl_modes_compliance(m, 2) >= 0.5 + 0.36 / 5.0);
    assert_near(fl_modes_max_omega2(m, 2), 49.0, 1e-15);
}

static void make_file(char path[64], const char *text)
{
    snprintf(path, 64, "/tmp/floe-modes-XXXXXX");
    const int fd = mkstemp(path);
    assert_true(fd >= 0);
    FILE *f = fdopen(fd, "w");
    fputs(text, f);
    fclose(f);
}

static int32_t read_modes(const char *text, const char *node, fl_modal_dof *m, fl_err *err)
{
    char path[64];
    *err = (fl_err){0};
    make_file(path, text);
    const int32_t n = fl_modes_read(m, path, node, err);
    unlink(path);
    return n;
}

static void tables_of_modes_are_read(void **state)
{
    fl_modal_dof m[FL_MODES_MOST];
    fl_err err;
    (void)state;
    assert_int_equal(
        read_modes("#modes 1\nmode\tf\tmass\tratio\tdirection\tshape\na\t2\t8\t0.01\ty\t2\n", "", m, &err),
        1);
    assert_near(m[0].mass, 2.0, 1e-15);
    assert_near(m[0].omega, 4 * PI, 1e-15);
    assert_near(m[0].e.y, 1.0, 0);
    assert_string_equal(m[0].name, "a");
    /* the second mode does not move the node */
    assert_int_equal(
        read_modes(
            "#modes "
            "1\nmode\tf\tmass\tratio\tw.x\tw.y\tw.z\n1\t2\t8\t0.01\t0.3\t0.4\t0\n2\t3\t8\t0\t0\t0\t0\n",
            "w", m, &err),
        1);
    assert_near(m[0].mass, 32.0, 1e-14);
    assert_near(m[0].e.x, 0.6, 1e-15);
}

static void bad_tables_are_refused(void **state)
{
    static const char *const it[][3] = {
        {"#modes 1\nmode\tf\tmass\tratio\n1\t2\t8\t0\n", "",
         "structure.modes_node, the node at the waterline"},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n1\t0\t8\t0\tx\n", "", "f is 0 Hz"},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n1\t1\t0\t0\tx\n", "", "mass is 0 kg"},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n1\t1\t1\t1\tx\n", "", "ratio is 1"},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n1\t1\t1\t0\tz\n", "", "direction \"z\""},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n1\t1\t1\t0\tx\n1\t2\t1\t0\tx\n", "", "is there twice"},
        {"#modes 1\nmode\tf\tmass\tratio\tdirection\n", "", "no mode moves the waterline"},
        {"#modes 1\nmode\tf\tmass\tratio\tw.x\n1\t1\t1\t0\t1\n", "v", "v.x"}};
    fl_modal_dof m[FL_MODES_MOST];
    fl_err err;
    (void)state;
    for (size_t k = 0; k < sizeof it / sizeof *it; k++) {
        assert_int_equal(read_modes(it[k][0], it[k][1], m, &err), -1);
        assert_int_equal(err.code, FL_INPUT);
        if (!strstr(err.text, it[k][2])) print_error("%s\n", err.text);
        assert_non_null(strstr(err.text, it[k][2]));
    }
}

static void scenes_with_modes_are_checked(void **state)
{
    static const char *const it[][3] = {
        {"mode a.mass=1", "mode a.frequency=0.5", NULL},
        {"mode a.mass=1", "mode a.part=nobody", "frequency is expected"},
        {"mode a.frequency=1", "mode a.part=nobody", "mass is expected"},
        {"mode a.frequency=1", "structure.free=x", "mass is expected"},
        {"structure.modes_node=w", "structure.friction=0.1", "no effect"},
    };
    (void)state;
    for (size_t k = 0; k < sizeof it / sizeof *it; k++) {
        lab l;
        fl_err err = {0};
        hit_pile(&l);
        lab_set(&l, it[k][0]);
        lab_set(&l, it[k][1]);
        l.scene.ice.head.present = l.scene.structure.head.present = 1;
        snprintf(l.scene.ice.file, sizeof l.scene.ice.file, "ice");
        snprintf(l.scene.structure.file, sizeof l.scene.structure.file, "structure");
        const int rc = fl_scene_check(&l.scene, &err);
        if (rc && it[k][2] && !strstr(err.text, it[k][2])) print_error("%s\n", err.text);
        assert_int_equal(rc, it[k][2] ? -1 : 0);
        if (it[k][2]) assert_non_null(strstr(err.text, it[k][2]));
        lab_free(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_mode_is_the_motion_of_a_spring), cmocka_unit_test(modes_add_up_at_the_waterline),
        cmocka_unit_test(tables_of_modes_are_read), cmocka_unit_test(bad_tables_are_refused),
        cmocka_unit_test(scenes_with_modes_are_checked)};
    return cmocka_run_group_tests_name("modal_motion", tests, NULL, NULL);
}
