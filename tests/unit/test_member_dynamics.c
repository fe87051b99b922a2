/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>
#include "base/pi.h"
#include "structure/member_motion.h"

static void read_model(fl_member_model *m, const char *text)
{
    fl_text in = {0};
    fl_err err = {0};
    assert_int_equal(fl_text_open_bytes(&in, "model", text, (int64_t)strlen(text), &err), 0);
    assert_int_equal(fl_member_model_read_text(m, &in, &err), 0);
    fl_text_close(&in);
}

/* A pipe of 10 m, clamped at its foot: EI = 2.4e8 N m2 or so. */
#define PIPE(pieces, more)                                                                                   \
    "#members 1\nnode foot 0 0 0\nnode head 0 0 10\nsection s pipe 0.6 0.02 2e11 8e10 7850\n"                \
    "member leg foot head s " pieces "\nfix foot clamped\n" more

static double relative(double x, double is) { return fabs(x - is) / fabs(is); }

static fl_member_section pipe_section(void) { return fl_member_section_pipe(0.6, 0.02, 2e11, 8e10, 7850); }

static void modes_are_those_of_a_cantilever(void **state)
{
    (void)state;
    static const double root[] = {1.8751040687, 4.6940911330};
    const fl_member_section s = pipe_section();
    fl_member_model m = {0};
    fl_member_dynamics d = {0};
    fl_err err = {0};
    read_model(&m, PIPE("32", ""));
    assert_int_equal(fl_member_dynamics_make(&d, &m, 0.02, &err), 0);
    for (int k = 0; k < 4; k++) { /* pairs of equal frequency; rotary inertia lowers them a little */
        const double omega = root[k / 2] * root[k / 2] / 100.0 * sqrt(s.eiy / s.mass);
        assert_true(relative(d.modes.omega[k], omega) < (k < 2 ? 2e-3 : 2e-2));
    }
    assert_true(relative(fl_member_modes_mass(&d.modes, 0), 0.25 * s.mass * 10.0) < 3e-3);
    fl_member_dynamics_free(&d);
    fl_member_model_free(&m);
}

static void loads_bend_it_by_f_l3_over_3_ei(void **state)
{
    (void)state;
    const fl_member_section s = pipe_section();
    fl_member_model m = {0};
    fl_member_dynamics d = {0};
    fl_err err = {0};
    fl_vec3 force, moment;
    read_model(&m, PIPE("8", "load head 100 0 -2000\n"));
    assert_int_equal(fl_member_dynamics_make(&d, &m, 0.0, &err), 0);
    assert_true(relative(d.chain.ball[1].d.x, 100.0 * 1000.0 / (3.0 * s.eiy)) < 1e-3);
    fl_member_section_forces(&d.chain, 0, &force, &moment); /* e1 up, local z along x, local y along -y */
    assert_true(relative(force.x, -2000.0) < 1e-6 && relative(force.z, 100.0) < 2e-3);
    assert_true(relative(moment.y, -100.0 * (10.0 - 10.0 / 16.0)) < 2e-3 && fabs(moment.z) < 1e-3);
    assert_true(fabs(fl_member_dynamics_energy(&d)) < 1e-12);
    fl_member_dynamics_free(&d);
    fl_member_model_free(&m);
}

/* Released from its deflection it swings at its frequency, and loses exp(-2 pi zeta) of the amplitude in a
 * period, whatever the step and its substeps. */
static void it_swings_and_is_damped_by_its_ratio(void **state)
{
    (void)state;
    for (int steps = 40; steps <= 400; steps *= 10) {
        fl_member_model m = {0};
        fl_member_dynamics d = {0};
        fl_err err = {0};
        read_model(&m, PIPE("8", ""));
        assert_int_equal(fl_member_dynamics_make(&d, &m, 0.03, &err), 0);
        const double period = 2.0 * PI / d.modes.omega[0], dt = period / steps;
        const double *shape = d.modes.shape;
        for (int32_t b = 0; b < d.chain.balls; b++) {
            const double *s = shape + 6 * b;
            d.chain.ball[b].v = v3_scale(1e-3, v3(s[0], s[1], s[2]));
            d.chain.ball[b].w = v3_scale(1e-3, v3(s[3], s[4], s[5]));
        }
        fl_member_dynamics_set_step(&d, dt);
        fl_member_dynamics_refresh(&d);
        const double start = fl_member_dynamics_kinetic(&d), top = v3_norm(d.chain.ball[1].v);
        const fl_vec3 along = v3_unit(d.chain.ball[1].v);
        for (int k = 0; k < 5 * steps; k++) {
            fl_member_dynamics_damp(&d);
            fl_member_dynamics_drift(&d);
            fl_member_dynamics_damp(&d);
        }
        const double left = v3_dot(along, d.chain.ball[1].v) / top,
                     energy = fl_member_dynamics_energy(&d) + fl_member_dynamics_kinetic(&d) + d.damped;
        assert_true(relative(left, exp(-10.0 * PI * 0.03)) < 0.02);
        assert_true(relative(energy, start) < 1e-3 * 1600.0 / (steps * steps) + 1e-4);
        assert_true(d.substeps > 1 || steps > 40);
        fl_member_dynamics_free(&d);
        fl_member_model_free(&m);
    }
}

/* Members on arms keep the energy: their part in the stable step is bounded too. */
static void arms_keep_the_energy(void **state)
{
    (void)state;
    fl_member_model m = {0};
    fl_member_dynamics d = {0};
    fl_err err = {0};
    read_model(&m,
               PIPE("3", "node far 5 0 10\nmember tie head far s 2 arm-i 0.2 0.5 1 arm-j -0.3 0 1\n"
                         "node low 5 0 0\nmember post low far s 2 hinge-j arm-j 0 0.4 0\nfix low clamped\n"));
    assert_int_equal(fl_member_dynamics_make(&d, &m, 0.0, &err), 0);
    for (int32_t b = 0; b < d.chain.balls; b++) {
        d.chain.ball[b].v =
            fl_member_free_part(v3(0.1 * cos(b), 0.1 * sin(b), 0.05), d.chain.ball[b].fixed & 7);
        d.chain.ball[b].w =
            fl_member_free_part(v3(0.02, 0.05 * cos(b), 0.01 * b), d.chain.ball[b].fixed >> 3);
    }
    fl_member_dynamics_set_step(&d, 1e-4);
    fl_member_dynamics_refresh(&d);
    const double start = fl_member_dynamics_kinetic(&d);
    double worst = 0.0;
    for (int k = 0; k < 5000; k++) {
        fl_member_dynamics_drift(&d);
        worst = fmax(worst, fabs(fl_member_dynamics_energy(&d) + fl_member_dynamics_kinetic(&d) - start));
    }
    if (!(worst < 0.1 * start)) fail_msg("energy is off by %g of %g, %d substeps", worst, start, d.substeps);
    fl_member_dynamics_free(&d);
    fl_member_model_free(&m);
}

/* A force on a cylinder and its work are those on the balls; ends that turn or not alike. */
static const char TRIPOD[] =
    "#members 1\nnode a 0 0 0\nnode b 3 0 0\nnode c 0 4 0\nnode d 1 1 5\nsection s bar 0.01 2e11 7850\n"
    "member 1 a d s 1\nmember 2 b d s 1\nmember 3 c d s 1\nfix a pinned\nfix b pinned\nfix c pinned\n";

static void forces_and_work_go_to_the_balls(void **state)
{
    (void)state;
    static const char *const text[] = {
        PIPE("5", ""), PIPE("3", "node far 5 0 0\nmember tie head far s 1 hinge-i\nfix far clamped\n"),
        PIPE(
            "3",
            "node far 5 0 0\nmember tie head far s 1 hinge-i arm-i 0.2 0 0.5 arm-j 0 1 0\nfix far clamped\n"),
        PIPE("2", "node far 5 0 0\nmember tie head far s 2 arm-i 0.2 0.4 0\nfix far clamped\n"), TRIPOD};
    for (int t = 0; t < 5; t++) {
        fl_member_model m = {0};
        fl_member_motion v = {0};
        fl_err err = {0};
        read_model(&m, text[t]);
        assert_int_equal(fl_member_motion_make(&v, &m, 6.5, 0.01, &err), 0);
        fl_member_chain *c = &v.dynamics.chain;
        for (int32_t b = 0; b < c->balls; b++) { /* a bent state that moves */
            c->ball[b].d = v3(0.01 * sin(b), 0.02 * cos(b), 0.005 * b);
            c->ball[b].q = q_of_vector(v3(0.02 * cos(b), 0.03, 0.01 * b));
            c->ball[b].v = v3(cos(2.0 * b), 0.3 * b, -0.4);
            c->ball[b].w = v3(0.1 * b, 0.7, cos(b));
        }
        for (int32_t k = 0; k < v.cylinders; k++) {
            const fl_vec3 f = v3(3, -2, 5), torque = v3(1, 4, -2), at = v3(0.4, 0.2, 7.0);
            fl_vec3 speed, spin, sum = v3(0, 0, 0), turn = v3(0, 0, 0), x;
            fl_quat q;
            double work = 0.0;
            fl_member_motion_clear(&v);
            fl_member_motion_load(&v, k, at, f, torque);
            fl_member_motion_velocity(&v, k, at, &speed, &spin);
            for (int32_t b = 0; b < c->balls; b++) {
                const fl_vec3 place = v3_add(c->ball[b].x0, c->ball[b].d);
                sum = v3_add(sum, v.dynamics.force[b]);
                turn = v3_add(turn,
                              v3_add(v3_cross(v3_sub(place, at), v.dynamics.force[b]), v.dynamics.moment[b]));
                work +=
                    v3_dot(v.dynamics.force[b], c->ball[b].v) + v3_dot(v.dynamics.moment[b], c->ball[b].w);
            }
            assert_true(v3_norm(v3_sub(sum, f)) < 1e-12);
            assert_true(fabs(work - v3_dot(f, speed) - v3_dot(torque, spin)) < 1e-11 * (1.0 + fabs(work)));
            fl_member_motion_pose(&v, k, &x, &q);
            const fl_vec3 along = q_rotate(q, v3(0, 0, 1));
            /* A bar takes no torque about its axis. */
            const fl_vec3 lost = v3_sub(torque, turn);
            assert_true(v3_norm(v3_cross(lost, along)) < 1e-11 * 40.0);
            if (c->contact[v.cylinder[k].contact].kind != FL_MEMBER_BAR)
                assert_true(v3_norm(lost) < 1e-11 * 40.0);
        }
        fl_member_motion_free(&v);
        fl_member_model_free(&m);
    }
}

static void cylinders_follow_a_rigid_rotation(void **state)
{
    (void)state;
    fl_member_model m = {0};
    fl_member_motion v = {0};
    fl_err err = {0};
    read_model(&m, PIPE("7", ""));
    assert_int_equal(fl_member_motion_make(&v, &m, 4.0, 0.0, &err), 0);
    const fl_quat r = q_of_vector(v3(0.3, -1.1, 0.7));
    fl_vec3 x0, x;
    fl_quat q0, q;
    fl_member_motion_pose(&v, 0, &x0, &q0);
    assert_true(v3_norm(v3_sub(x0, v.cylinder[0].p0)) < 1e-14);
    for (int32_t b = 0; b < v.dynamics.chain.balls; b++) {
        fl_member_ball *a = &v.dynamics.chain.ball[b];
        a->q = r;
        a->d = v3_sub(v3_add(q_rotate(r, a->x0), v3(1, 2, 3)), a->x0);
    }
    fl_member_motion_pose(&v, 0, &x, &q);
    assert_true(v3_norm(v3_sub(x, v3_add(q_rotate(r, x0), v3(1, 2, 3)))) < 1e-13);
    const fl_quat same = q_mul(q, q_conj(q_mul(r, q0)));
    assert_true(fabs(fabs(same.w) - 1.0) < 1e-14);
    fl_member_motion_free(&v);
    fl_member_model_free(&m);
}

/* The carrier is the piece at the surface of the water, else that in the middle. */
static void cylinders_ride_on_the_piece_at_the_waterline(void **state)
{
    (void)state;
    static const double level[] = {9.9, 3.0, -1.0};
    static const int32_t piece[] = {9, 3, 4};
    for (int k = 0; k < 3; k++) {
        fl_member_model m = {0};
        fl_member_motion v = {0};
        fl_err err = {0};
        read_model(&m, PIPE("10", ""));
        assert_int_equal(fl_member_motion_make(&v, &m, level[k], 0.0, &err), 0);
        assert_int_equal(v.cylinders, 1);
        assert_int_equal(v.cylinder[0].contact, piece[k]);
        fl_member_motion_free(&v);
        fl_member_model_free(&m);
    }
}

static void fails_with(const char *text, const char *part)
{
    fl_member_model m = {0};
    fl_member_motion v = {0};
    fl_err err = {0};
    read_model(&m, text);
    assert_int_equal(fl_member_motion_make(&v, &m, 0.0, 0.01, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    if (!strstr(err.text, part)) fail_msg("\"%s\", expected \"%s\"", err.text, part);
    fl_member_model_free(&m);
}

static void what_cannot_be_is_one_sentence(void **state)
{
    (void)state;
    fails_with("#members 1\nnode a 0 0 0\nnode b 0 0 1\nsection s pipe 1 .1 1 1\nmember 1 a b s 1\nfix a "
               "clamped\n",
               "model:5: member 1 has no mass");
    fails_with(
        "#members 1\nnode a 0 0 0\nnode b 0 0 1\nsection s 1 1 1 1 1\nmember 1 a b s 1\nfix a clamped\n",
        "no section has a radius");
    fails_with(PIPE("2", "move head 1 0 0\n"), "imposed displacement");
    fails_with(PIPE("2", "load head 1e4 0 -1e8\n"), "no equilibrium");
}

static void a_model_reads_back_as_it_was_written(void **state)
{
    (void)state;
    fl_member_model m = {0}, again = {0};
    fl_text in = {0};
    fl_err err = {0};
    char *text = NULL, *second = NULL;
    size_t n = 0, n2 = 0;
    read_model(
        &m,
        "#members 1\n#by x\nnode a 0 0 0\nnode b 0 0 1\nnode c 0.1 0 2 hinge\nsection s pipe 1 .1 3 2 7\n"
        "section g 1 2 3 4 5 6\nsection r rect .1 .3 7 9 11\nsection k bar .5 7 8\npart P\nmember 1 a b s 3 "
        "cylinders 2\nmember 2 a c g 1 hinge-i ref 1 2 3\npart Q\nmember 3 b c r 2 bow .01 z\nmember 4 a c k "
        "1\nfix a clamped\nfix c x rz\nmass b 12.5\nload b 1 2 3 4 5 6\nmove c 0 .1 0\noffset b .01 0 0\n");
    FILE *f = open_memstream(&text, &n);
    fl_member_model_write(f, &m, NULL);
    fclose(f);
    assert_int_equal(fl_text_open_bytes(&in, "again", text, (int64_t)n, &err), 0);
    assert_int_equal(fl_member_model_read_text(&again, &in, &err), 0);
    fl_text_close(&in);
    f = open_memstream(&second, &n2);
    fl_member_model_write(f, &again, NULL);
    fclose(f);
    assert_string_equal(text, second);
    assert_true(strstr(text, "fix c x rz\n") && strstr(text, "mass b 12.5\n") &&
                strstr(text, "cylinders 2\n"));
    for (int32_t k = 0; k < m.section_name.n; k++)
        assert_memory_equal(&m.section[k], &again.section[k], sizeof m.section[k]);
    free(text), free(second);
    fl_member_model_free(&m);
    fl_member_model_free(&again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(modes_are_those_of_a_cantilever),
                                       cmocka_unit_test(loads_bend_it_by_f_l3_over_3_ei),
                                       cmocka_unit_test(it_swings_and_is_damped_by_its_ratio),
                                       cmocka_unit_test(arms_keep_the_energy),
                                       cmocka_unit_test(forces_and_work_go_to_the_balls),
                                       cmocka_unit_test(cylinders_follow_a_rigid_rotation),
                                       cmocka_unit_test(cylinders_ride_on_the_piece_at_the_waterline),
                                       cmocka_unit_test(what_cannot_be_is_one_sentence),
                                       cmocka_unit_test(a_model_reads_back_as_it_was_written)};
    return cmocka_run_group_tests_name("member_dynamics", tests, NULL, NULL);
}
