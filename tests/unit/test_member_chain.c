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
#include "member/imperfection.h"
#include "member/mechanism.h"
#include "member/member_path.h"
#include "member/member_stiffness.h"

static void read_model(fl_member_model *m, const char *text)
{
    fl_text in = {0};
    fl_err err = {0};
    assert_int_equal(fl_text_open_bytes(&in, "model", text, (int64_t)strlen(text), &err), 0);
    assert_int_equal(fl_member_model_read_text(m, &in, &err), 0);
    fl_text_close(&in);
}

static int is_mechanism(const char *text)
{
    fl_member_model m = {0};
    fl_err err = {0};
    read_model(&m, text);
    const int bad = fl_member_check_mechanism(&m, &err) != 0;
    fl_member_model_free(&m);
    return bad;
}

static void sections_are_those_of_handbooks(void **state)
{
    (void)state;
    const fl_member_section pipe = fl_member_section_pipe(0.18, 0.005, 1.0, 1.0, 2.0);
    assert_true(fabs(pipe.ea - PI / 4 * (0.18 * 0.18 - 0.17 * 0.17)) < 1e-15);
    assert_true(fabs(pipe.eiy - PI / 64 * (pow(0.18, 4) - pow(0.17, 4))) < 1e-17 &&
                pipe.gj == 2.0 * pipe.eiz);
    assert_true(fabs(pipe.mass - 2.0 * pipe.ea) < 1e-15);
    /* Torsion of a square: 0.140577 a4 (Timoshenko); of a long strip: b3 a/3 (1 - 0.630 b/a). */
    const fl_member_section square = fl_member_section_rectangle(1.0, 1.0, 1.0, 1.0, 0.0);
    assert_true(fabs(square.gj - 0.140577) < 1e-6);
    const fl_member_section strip = fl_member_section_rectangle(0.1, 2.0, 1.0, 1.0, 0.0);
    assert_true(fabs(strip.gj - 0.001 * 2.0 / 3.0 * (1.0 - 0.63025 * 0.05)) < 1e-8);
    assert_true(fabs(strip.eiy - 0.1 * 8.0 / 12.0) < 1e-15 && fabs(strip.eiz - 2.0 * 0.001 / 12.0) < 1e-15);
}

static void mechanisms_are_told_from_spins(void **state)
{
    (void)state;
    static const char *const good[] = {
        /* a cantilever; a pinned beam that can spin; a truss; a beam with a released end */
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nsection s 1 1 1 1\nmember 1 a b s 3\nfix a clamped\n",
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nsection s 1 1 1 1\nmember 1 a b s 3\nfix a pinned\nfix b y "
        "z\n",
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nnode c 0 1 0\nnode d 0 0 1\nsection s bar 1 1\nmember 1 a d "
        "s 1\n"
        "member 2 b d s 1\nmember 3 c d s 1\nfix a pinned\nfix b pinned\nfix c pinned\n",
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nsection s 1 1 1 1\nmember 1 a b s 3 hinge-j\nfix a "
        "clamped\nfix b z\n"};
    static const char *const bad[] = {
        /* a beam on one pin; two bars in line; three bars in a plane; a hinge in a beam; free in space */
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nsection s 1 1 1 1\nmember 1 a b s 3\nfix a pinned\n",
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nnode c 2 0 0\nsection s bar 1 1\nmember 1 a b s 1\nmember 2 "
        "b c s 1\nfix a "
        "pinned\nfix c pinned\n",
        ("#members 1\nnode a 0 0 0\nnode b 1 0 0\nnode c 0 1 0\nnode d 0.3 0.4 0\nsection s bar 1 1\n"
         "member 1 a d s 1\nmember 2 b d s 1\nmember 3 c d s 1\nfix a pinned\nfix b pinned\nfix c pinned\n"),
        ("#members 1\nnode a 0 0 0\nnode b 1 0 0\nnode c 2 0 0 \nsection s 1 1 1 1\nmember 1 a b s 3 "
         "hinge-j\n"
         "member 2 b c s 3\nfix a pinned\nfix c pinned\n"),
        "#members 1\nnode a 0 0 0\nnode b 1 0 0\nsection s 1 1 1 1\nmember 1 a b s 3\n"};
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) assert_int_equal(is_mechanism(good[k]), 0);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) assert_int_equal(is_mechanism(bad[k]), 1);
}

/* A cantilever of 2 m whose end stands 0.5 m above its node: forces at the node bend and twist it by their
 * arm. EA 100, EIy 3, EIz 5, GJ 2, a = 0.5, l = 2:
 *     FX: x moves by l/EA + a2 l/EIy, z by a l2/(2 EIy)
 *     FY: y moves by l3/(3 EIz) + a2 l/GJ,    FZ: z by l3/(3 EIy), x by a l2/(2 EIy) */
static void an_arm_turns_with_its_node(void **state)
{
    (void)state;
    static const double l = 2.0, a = 0.5, load = 1e-4;
    for (int pieces = 1; pieces <= 4; pieces += 3)
        for (int axis = 0; axis < 3; axis++) {
            char text[400];
            fl_member_model m = {0};
            fl_member_chain c = {0};
            fl_path p = {0};
            fl_err err = {0};
            snprintf(text, sizeof text,
                     "#members 1\nnode a 0 0 0.7\nnode b 2 0 -0.5\nsection s 100 3 5 2\n"
                     "member 1 a b s %d arm-i 0 0 -0.7 arm-j 0 0 0.5\nfix a clamped\nload b %d %d %d\n",
                     pieces, axis == 0, axis == 1, axis == 2);
            read_model(&m, text);
            assert_int_equal(fl_member_check_mechanism(&m, &err), 0);
            assert_int_equal(fl_member_chain_make(&c, &m, 1.0, &err), 0);
            fl_path_options o = fl_path_defaults();
            o.constraint = FL_ARC_LOAD;
            o.first = load;
            o.chi = 1e-7;
            o.damping = FL_RELAXATION_ADAPTIVE;
            assert_int_equal(fl_path_start(&p, &c, &o, &err), 0);
            assert_int_equal(fl_path_next(&p, &err), 0);
            const double expected[3] = {l / 100.0 + a * a * l / 3.0, l * l * l / 15.0 + a * a * l / 2.0,
                                        l * l * l / 9.0},
                         beside = a * l * l / 6.0, d = v3_at(c.ball[1].d, axis) / load;
            assert_true(fabs(d / expected[axis] - 1.0) < 2e-4);
            if (axis != 1) assert_true(fabs(fabs(v3_at(c.ball[1].d, 2 - axis)) / load / beside - 1.0) < 2e-4);
            fl_member_stiffness s = {0};
            assert_int_equal(fl_member_stiffness_make(&s, &c, "model", &err), 0);
            double x[6 * 8] = {0};
            for (int32_t k = 0; k < s.n; k++) x[k] = s.dof[k] == 6 + axis;
            fl_member_stiffness_solve(&s, x);
            for (int32_t k = 0; k < s.n; k++)
                if (s.dof[k] == 6 + axis) assert_true(fabs(x[k] / expected[axis] - 1.0) < 1e-12);
            fl_member_stiffness_free(&s);
            fl_path_free(&p);
            fl_member_chain_free(&c);
            fl_member_model_free(&m);
        }
}

/* A cantilever under a small load: the Euler-Bernoulli element for any number of pieces. */
static void a_chain_is_the_beam_where_displacements_are_small(void **state)
{
    (void)state;
    for (int pieces = 1; pieces <= 6; pieces++) {
        char text[400];
        fl_member_model m = {0};
        fl_member_chain c = {0};
        fl_path p = {0};
        fl_err err = {0};
        snprintf(
            text, sizeof text,
            "#members 1\nnode a 0 0 0\nnode b 2 0 0\nsection s 100 3 5 2\nmember 1 a b s %d\nfix a clamped\n"
            "load b 0 1 1 1 0 0\n",
            pieces);
        read_model(&m, text);
        assert_int_equal(fl_member_chain_make(&c, &m, 1.0, &err), 0);
        fl_path_options o = fl_path_defaults();
        o.constraint = FL_ARC_LOAD;
        o.first = 1e-4;
        o.chi = 1e-7;
        o.damping = FL_RELAXATION_ADAPTIVE;
        assert_int_equal(fl_path_start(&p, &c, &o, &err), 0);
        assert_int_equal(fl_path_next(&p, &err), 0);
        /* P l3/3EI each way, M l/GJ; first order: the twist of 1e-4, which turns the axes of the section. */
        assert_true(fabs(c.ball[1].d.y / (1e-4 * 8.0 / 15.0) - 1.0) < 2e-4);
        assert_true(fabs(c.ball[1].d.z / (1e-4 * 8.0 / 9.0) - 1.0) < 2e-4);
        assert_true(fabs(2.0 * c.ball[1].q.x / (1e-4 * 2.0 / 2.0) - 1.0) < 2e-4);
        fl_path_free(&p);
        fl_member_chain_free(&c);
        fl_member_model_free(&m);
    }
}

/* A lattice of more balls than threads are used for: the same bits by one and by three threads. */
static void threads_change_no_bit(void **state)
{
    (void)state;
    enum { SIDE = 16, PIECES = 11 };
    char *text = malloc(200000);
    size_t n = 0;
    double d[2][3], lambda[2];
    assert_non_null(text);
    n += (size_t)sprintf(text + n, "#members 1\nsection s 1e4 10 10 10\n");
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++)
            n += (size_t)sprintf(text + n, "node %d.%d %d %d %.3f\n", i, j, i, j, 0.02 * i * (SIDE - 1 - i));
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            if (i + 1 < SIDE)
                n += (size_t)sprintf(text + n, "member x%d.%d %d.%d %d.%d s %d\n", i, j, i, j, i + 1, j,
                                     PIECES);
            if (j + 1 < SIDE)
                n += (size_t)sprintf(text + n, "member y%d.%d %d.%d %d.%d s %d\n", i, j, i, j, i, j + 1,
                                     PIECES);
            if (i == 0 || i == SIDE - 1) n += (size_t)sprintf(text + n, "fix %d.%d pinned\n", i, j);
            if (i == SIDE / 2) n += (size_t)sprintf(text + n, "load %d.%d 0 0 -1\n", i, j);
        }
    for (int k = 0; k < 2; k++) {
        fl_member_model m = {0};
        fl_member_chain c = {0};
        fl_err err = {0};
        read_model(&m, text);
        fl_member_scatter(&m, 1e-3, 5);
        assert_int_equal(fl_member_chain_make(&c, &m, 1.0, &err), 0);
        assert_true(c.balls > 4000);
        c.threads = 1 + 2 * k;
        fl_relaxation r = fl_relaxation_start(FL_RELAXATION_ADAPTIVE, 0.0);
        lambda[k] = 0.1;
        for (int t = 0; t < 60; t++) {
            fl_member_chain_forces(&c);
            const fl_member_state f = fl_member_chain_state(&c, lambda[k]);
            if (t > 0) fl_relaxation_adapt(&r, f.work, f.inertia, 1.0);
            const double c2 = fl_relaxation_c2(&r);
            const fl_member_half h = fl_member_chain_free_step(&c, fl_relaxation_c1(&r), c2, NULL);
            if (t > 20) (void)fl_arc_root(h.bb, h.ab, h.aa * (1.0 - 1e-3), h.db, lambda[k], &lambda[k]);
            fl_relaxation_peak(&r, h.kinetic + fl_member_chain_loaded_step(&c, c2, lambda[k]));
        }
        d[k][0] = c.ball[300].d.x, d[k][1] = c.ball[1000].d.y, d[k][2] = c.ball[4000].d.z;
        fl_member_chain_free(&c);
        fl_member_model_free(&m);
    }
    assert_memory_equal(d[0], d[1], sizeof d[0]);
    assert_true(lambda[0] == lambda[1]);
    free(text);
}

/* Lanes give the bits of one contact and of one ball. */
static void lanes_change_no_bit(void **state)
{
    static const char text[] = "#members 1\nsection s 2e3 30 20 15\nsection t pipe 2 0.1 2e3 800\n"
                               "node a 0 0 0\nnode b 9 1 0.5\nnode c 20 0 2\nnode d 12 9 3 hinge\n"
                               "member 1 a b s 9\nmember 2 b c t 10\nmember 3 b d s 8\nmember 4 c d t 6\n"
                               "fix a clamped\nfix c pinned\nfix d pinned\nload b 0.3 0.2 -1 0 0.1 0\n";
    enum { SCALAR = 64, STEPS = 40 }; /* a bit of `fixed` that holds nothing, and keeps a ball out of lanes */
    (void)state;
    fl_member_model m = {0};
    fl_member_chain c[2] = {0};
    fl_err err = {0};
    fl_member_half h[2];
    fl_member_state s[2];
    read_model(&m, text);
    for (int n = 0; n < 2; n++) assert_int_equal(fl_member_chain_make(&c[n], &m, 1.0, &err), 0);
    assert_true(c[0].beam_sets > 6 && c[0].others == 2 && c[0].balls % FL_SIMD_WIDTH != 0);
    fl_vec3 *from = calloc((size_t)c[0].balls, sizeof *from);
    assert_non_null(from);
    c[1].beam_sets = 0, c[1].others = c[1].contacts;
    free(c[1].other);
    c[1].other = calloc((size_t)c[1].contacts, sizeof *c[1].other);
    assert_non_null(c[1].other);
    for (int32_t k = 0; k < c[1].contacts; k++) c[1].other[k] = k;
    for (int32_t b = 0; b < c[1].balls; b++) {
        c[1].ball[b].fixed |= SCALAR;
        from[b] = v3(0.01 * sin(b), 0.02 * cos(b), 1e-3 * b);
    }
    for (int t = 0; t < STEPS; t++) {
        if (t % 10 ==
            0) /* from small turns of a step and of a piece to large ones, and opposite quaternions */
            for (int n = 0; n < 2; n++)
                for (int32_t b = 0; b < c[n].balls; b++) {
                    fl_member_ball *a = &c[n].ball[b];
                    const double turn = 0.003 * (t + 1);
                    if (a->over_i > 0.0) a->w = v3(turn * cos(b), turn * sin(2.0 * b), turn);
                    if (b % 3 == 0) a->q = (fl_quat){-a->q.w, -a->q.x, -a->q.y, -a->q.z};
                }
        for (int n = 0; n < 2; n++) {
            fl_member_chain_forces(&c[n]);
            s[n] = fl_member_chain_state(&c[n], 0.3);
            h[n] = fl_member_chain_free_step(&c[n], 0.97, 0.98, t & 1 ? from : NULL);
            fl_member_chain_loaded_step(&c[n], 0.98, 0.3);
        }
        assert_memory_equal(c[0].force, c[1].force, (size_t)c[0].contacts * sizeof *c[0].force);
        assert_memory_equal(c[0].resist, c[1].resist, (size_t)c[0].balls * sizeof *c[0].resist);
        assert_memory_equal(&s[0], &s[1], sizeof s[0]);
        assert_memory_equal(&h[0], &h[1], sizeof h[0]);
        assert_true(c[0].largest_rotation2 == c[1].largest_rotation2);
        for (int32_t b = 0; b < c[0].balls; b++)
            assert_memory_equal(&c[0].ball[b], &c[1].ball[b], offsetof(fl_member_ball, fixed));
    }
    assert_true(c[0].largest_rotation2 > 0.1);
    free(from);
    for (int n = 0; n < 2; n++) fl_member_chain_free(&c[n]);
    fl_member_model_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sections_are_those_of_handbooks),
                                       cmocka_unit_test(mechanisms_are_told_from_spins),
                                       cmocka_unit_test(an_arm_turns_with_its_node),
                                       cmocka_unit_test(a_chain_is_the_beam_where_displacements_are_small),
                                       cmocka_unit_test(threads_change_no_bit),
                                       cmocka_unit_test(lanes_change_no_bit)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
