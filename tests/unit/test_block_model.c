/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "support/block_cuts.h"
#include "base/rng.h"
#include "block/closed_surface.h"
#include "block/sliver.h"
#include "geom/clip.h"
#include "geom/facet.h"
#include "geom/hilbert_order.h"

static void persistence_glues_pairs_by_chance(void **state)
{
    (void)state;
    static const char *const SET[] = {
        "name=a dip=0 dd=0 spacing=.5 origin=0,0,.1 persistence=.3 meaning=glue",
        "name=b dip=90 dd=90 spacing=.5 origin=.1,0,0", NULL};
    rock_cut t;
    int32_t intact = 0, all = 0;
    rock_cut_box(&t, v3(0, 0, 0), v3(10, 1, 10), SET, 5);
    for (int32_t k = 0; k < t.pairs.n; k++) {
        const int is_a = t.sets.set[t.m.plane[t.pairs.pair[k].plane].set].name[0] == 'a';
        all += is_a, intact += is_a && t.pairs.pair[k].intact;
        assert_true(is_a || !t.pairs.pair[k].intact);
    }
    assert_int_equal(all, 20 * 21);
    assert_near_of(intact, 0.7 * all, 3.0, sqrt(0.21 * all));
    rock_cut_free(&t);
}

/* The faces of a pair have the same corners, bit for bit, where every block is cut. */
static void both_sides_of_a_cut_have_the_same_corners(void **state)
{
    (void)state;
    static const char *const SET[] = {"dip=70 dd=20 spacing=1.3 origin=.3,.4,.5",
                                      "dip=25 dd=200 spacing=1.7 origin=.1,.9,.2",
                                      "dip=85 dd=110 spacing=1.9 origin=.7,.2,.6", NULL};
    rock_cut t;
    rock_cut_box(&t, v3(0, 0, 0), v3(12, 8, 6), SET, 1);
    for (int32_t k = 0; k < t.pairs.n; k++) {
        const fl_face_pair *p = &t.pairs.pair[k];
        const fl_block_shape *a = &t.m.block[p->i], *b = &t.m.block[p->j];
        const int32_t n = a->first[p->fi + 1] - a->first[p->fi];
        assert_int_equal(b->first[p->fj + 1] - b->first[p->fj], n);
        for (int32_t u = 0; u < n; u++) {
            const fl_vec3 x = a->v[a->loop[a->first[p->fi] + u]];
            int same = 0;
            for (int32_t v = 0; v < n; v++) {
                const fl_vec3 y = b->v[b->loop[b->first[p->fj] + v]];
                same += x.x == y.x && x.y == y.y && x.z == y.z;
            }
            assert_int_equal(same, 1);
        }
    }
    rock_cut_free(&t);
}

/* Planes through corners, edges and each other's lines, and sets 0.01 degrees apart. */
static void special_positions_are_cut_without_splinters(void **state)
{
    (void)state;
    static const char *const CORNERS[] = {"dip=45 dd=90 spacing=2 origin=0,0,0",
                                          "dip=45 dd=270 spacing=2 origin=0,0,0",
                                          "dip=90 dd=0 spacing=2 origin=0,0,0", NULL};
    static const char *const PARALLEL[] = {"dip=30 dd=90 spacing=2 origin=1,1,1",
                                           "dip=30.01 dd=90 spacing=2 origin=1,1,1.3",
                                           "dip=80 dd=20 spacing=2.2 origin=1,1,1", NULL};
    const char *const *const all[] = {CORNERS, PARALLEL};
    for (int k = 0; k < 2; k++) {
        rock_cut t;
        rock_cut_box(&t, v3(0, 0, 0), v3(10, 10, 10), all[k], 1);
        assert_near(t.c.volume, 1000.0, 1e-12);
        for (int32_t s = 0; s < t.sets.n; s++) assert_near(t.c.area[s], t.c.section[s], 1e-9);
        for (int32_t b = 0; b < t.m.n; b++) {
            fl_poly p = {0};
            fl_err err = {0};
            assert_int_equal(fl_block_shape_poly(&t.m.block[b], &p, NULL, &err), 1);
            fl_poly_free(&p);
        }
        rock_cut_free(&t);
    }
}

/* Random planes in a box: the count holds for every seed. */
static void the_count_holds_for_random_planes(void **state)
{
    (void)state;
    for (int seed = 1; seed <= 60; seed++) {
        fl_rng g = fl_rng_of((uint64_t)seed, 0, FL_RNG_TEST);
        char text[8][160];
        const char *set[9] = {0};
        rock_cut t;
        for (int k = 0; k < 8; k++) {
            snprintf(text[k], sizeof text[k], "dip=%.17g dd=%.17g n=1 origin=%.17g,%.17g,%.17g",
                     fl_rng_in(&g, 0, 90), fl_rng_in(&g, 0, 360), fl_rng_in(&g, 0, 3), fl_rng_in(&g, 0, 2),
                     fl_rng_in(&g, 0, 1));
            set[k] = text[k];
        }
        rock_cut_box(&t, v3(0, 0, 0), v3(3, 2, 1), set, 1);
        assert_int_equal(t.c.pieces + t.c.planes + t.c.lines + t.c.points, t.m.n);
        assert_near(t.c.volume, 6.0, 1e-12);
        rock_cut_free(&t);
    }
}

/* An L-shaped prism with a pit: convex pieces that fill it, cut like any other. */
static void a_model_that_is_not_convex_is_cut_in_convex_pieces(void **state)
{
    (void)state;
    static const double XY[6][2] = {{0, 0}, {4, 0}, {4, 4}, {2, 4}, {2, 2}, {0, 2}};
    fl_part l = {0}, pit = {0};
    fl_err err = {0};
    fl_block_model m;
    fl_joint_sets sets = {0};
    fl_face_pairs pairs;
    fl_block_certificate c;
    assert_int_equal(fl_closed_surface_prism(&l, 6, XY, 0.0, 3.0, &err), 0);
    assert_near(fl_closed_surface_volume(&l), 36.0, 1e-12);
    assert_int_equal(fl_block_model_surface(&m, &l, &err), 0);
    assert_near(m.volume, 36.0, 1e-12);
    assert_int_equal(fl_facet_box(&pit, v3(1, 0.5, 1), v3(1.7, 1.5, 5), &err), 0);
    assert_int_equal(fl_block_model_region(&m, &pit, "pit", &err), 0);
    assert_int_equal(fl_joint_sets_add(&sets, "dip=37 dd=80 spacing=.7 origin=.1,.2,.3", "test", &err), 0);
    assert_int_equal(fl_block_model_cut(&m, &sets, 1, &err), 0);
    assert_int_equal(fl_face_pairs_find(&pairs, &m, &sets, 1, &err), 0);
    assert_int_equal(fl_block_certify(&c, &m, &pairs, &sets, &err), 0);
    assert_near(c.volume, 36.0, 1e-12);
    assert_int_equal(c.pieces + c.planes + c.lines + c.points, m.n);
    assert_near(c.area[0], c.section[0], 1e-9);
    double dug = 0.0;
    for (int32_t k = 0; k < m.n; k++)
        if (m.block[k].group >= 0) dug += fl_block_shape_volume(&m.block[k], NULL);
    assert_near(dug, 0.7 * 1.0 * 2.0, 1e-12);
    assert_true(fl_block_model_delete(&m, "pit", &err) > 0);
    assert_int_equal(fl_block_model_delete(&m, "hole", &err), -1);
    fl_block_certificate_free(&c);
    fl_face_pairs_free(&pairs);
    fl_block_model_free(&m);
    fl_joint_sets_free(&sets);
    fl_part_free(&l), fl_part_free(&pit);
}

/* Slivers go into neighbours: the volume stays, and every block has a core. */
static void slivers_are_merged_with_neighbours(void **state)
{
    (void)state;
    static const char *const SET[] = {"dip=70 dd=20 spacing=1.3 origin=.3,.4,.5",
                                      "dip=25 dd=200 spacing=1.7 origin=.1,.9,.2",
                                      "dip=85 dd=110 spacing=1.9 origin=.7,.2,.6", NULL};
    const double R = 0.0013;
    rock_cut t;
    fl_err err = {0};
    fl_slivers s;
    double volume = 0.0;
    rock_cut_box(&t, v3(0, 0, 0), v3(12, 8, 6), SET, 1);
    assert_int_equal(fl_slivers_remove(&s, &t.m, &t.pairs, &t.sets, 1,
                                       &(fl_sliver_rule){.min_width = 2.2 * R, .radius = R}, &err),
                     0);
    assert_int_equal(s.n, 4);
    assert_int_equal(s.merged, 4);
    assert_int_equal(t.m.n, 274);
    for (int32_t k = 0; k < t.m.n; k++) {
        fl_poly p = {0}, core = {0};
        volume += fl_block_shape_volume(&t.m.block[k], NULL);
        assert_int_equal(fl_block_shape_poly(&t.m.block[k], &p, NULL, &err), 1);
        assert_int_equal(fl_poly_offset(&core, &p, -R, &err), 0);
        fl_poly_free(&p), fl_poly_free(&core);
    }
    assert_near(volume, 576.0, 1e-12);
    fl_slivers_free(&s);
    rock_cut_free(&t);
}

static void joints_that_coincide_are_refused(void **state)
{
    (void)state;
    fl_joint_sets sets = {0};
    fl_block_model m;
    fl_err err = {0};
    assert_int_equal(fl_joint_sets_add(&sets, "name=a dip=30 dd=90 spacing=2 origin=1,1,1", "x", &err), 0);
    assert_int_equal(fl_joint_sets_add(&sets, "name=b dip=30 dd=90 n=1 origin=1,1,1", "x", &err), 0);
    fl_joint_sets_sort(&sets);
    assert_int_equal(fl_block_model_box(&m, v3(0, 0, 0), v3(3, 3, 3), &err), 0);
    assert_int_equal(fl_block_model_cut(&m, &sets, 1, &err), -1);
    assert_int_equal(err.code, FL_INPUT);
    assert_non_null(strstr(err.text, "coincide"));
    fl_block_model_free(&m);
    fl_joint_sets_free(&sets);
}

/* Normals about the mean: E cos t = coth K - 1/K.  Spacings with the mean and deviation asked. */
static void scatter_has_the_moments_asked(void **state)
{
    (void)state;
    enum { N = 20000 };
    fl_joint_set s = {
        .dip = 30, .direction = 60, .spacing = 2.0, .fisher = 40.0, .deviation = 0.3, .log_normal = 1};
    double cosine = 0.0, last = 0.0, sum = 0.0, square = 0.0;
    const fl_vec3 n = fl_joint_set_normal(&s);
    for (int32_t k = 1; k <= N; k++)
        cosine += v3_dot(n, fl_joint_set_plane(
                                &(fl_joint_set){.dip = 30, .direction = 60, .spacing = 2.0, .fisher = 40.0},
                                0, k, 3)
                                .n) /
                  N;
    assert_near_of(cosine, 1.0 / tanh(40.0) - 1.0 / 40.0, 3.0 / sqrt(N), 1.0 / 40.0);
    s.fisher = 0.0;
    for (int32_t k = 1; k <= 2000; k++) {
        const double c = fl_joint_set_plane(&s, 0, k, 3).c, gap = c - last;
        last = c;
        sum += gap / 2000, square += gap * gap / 2000;
    }
    assert_near_of(sum, 2.0, 4.0 / sqrt(2000.0), 0.6);
    assert_near(sqrt(square - sum * sum), 0.6, 0.1);
}

static void the_curve_in_space_is_continuous(void **state)
{
    (void)state;
    enum { SIDE = 8 };
    static int32_t at[SIDE * SIDE * SIDE][3];
    static char taken[SIDE * SIDE * SIDE];
    for (uint32_t k = 0; k < SIDE * SIDE * SIDE; k++) {
        const uint32_t x = k % SIDE, y = k / SIDE % SIDE, z = k / SIDE / SIDE;
        const uint64_t i = fl_hilbert_index3(x, y, z);
        assert_true(i < SIDE * SIDE * SIDE);
        assert_false(taken[i]);
        taken[i] = 1, at[i][0] = (int32_t)x, at[i][1] = (int32_t)y, at[i][2] = (int32_t)z;
    }
    for (int k = 1; k < SIDE * SIDE * SIDE; k++)
        assert_int_equal(
            abs(at[k][0] - at[k - 1][0]) + abs(at[k][1] - at[k - 1][1]) + abs(at[k][2] - at[k - 1][2]), 1);
}

int main(void)
{
    const struct CMUnitTest test[] = {
        cmocka_unit_test(persistence_glues_pairs_by_chance),
        cmocka_unit_test(both_sides_of_a_cut_have_the_same_corners),
        cmocka_unit_test(special_positions_are_cut_without_splinters),
        cmocka_unit_test(the_count_holds_for_random_planes),
        cmocka_unit_test(a_model_that_is_not_convex_is_cut_in_convex_pieces),
        cmocka_unit_test(slivers_are_merged_with_neighbours),
        cmocka_unit_test(joints_that_coincide_are_refused),
        cmocka_unit_test(scatter_has_the_moments_asked),
        cmocka_unit_test(the_curve_in_space_is_continuous),
    };
    return cmocka_run_group_tests(test, NULL, NULL);
}
