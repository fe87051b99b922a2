/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Near pairs are divided among threads by the contacts of the previous step. Each pair is evaluated exactly
 * once. */
#include <string.h>
#include "base/array.h"
#include "base/rng.h"
#include "contact/active_pairs.h"
#include "contact/pair_gap.h"
#include "contact/pair_geometry.h"
#include "contact/pair_store.h"
#include "support/small_world.h"
#include "support/near.h"
#include "world/access.h"

/* 144 floes in rows: floes of a row touch, and floes of neighbouring rows are near pairs. */
static void make_floe_rows(lab *l, int threads)
{
    lab_start(l);
    lab_setf(l, "run.threads=%d", threads);
    for (int k = 0; k < 144; k++)
        lab_box(l, v3(0.999 * (k % 12), 1.01 * (k / 12), 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0),
                v3(0, 0, 0));
    lab_make(l, 1e-5);
    assert_int_equal(l->w.threads, threads);
    assert_true(l->w.n_touching >= 12 * 11 && l->w.n_touching < l->w.n_pair / 2);
}

/* Counts the contacts of a share. Consecutive shares cover all pairs. */
static void shares_are_even(void **state)
{
    (void)state;
    lab l;
    make_floe_rows(&l, 5);
    const fl_world *w = &l.w;
    fl_share_active_pairs(&l.w);
    assert_int_equal(w->pair_share[0].next, 0);
    for (int32_t t = 0; t < 5; t++) {
        int32_t many = 0;
        for (int32_t k = 0; k < w->n_touching; k++)
            many +=
                w->touching_pairs[k] >= w->pair_share[t].next && w->touching_pairs[k] < w->pair_share[t].end;
        assert_true(many == w->n_touching / 5 || many == w->n_touching / 5 + 1);
        assert_int_equal(w->pair_share[t].end, t < 4 ? w->pair_share[t + 1].next : w->n_pair);
    }
    lab_free(&l);
}

/* Before the first contact, shares are balanced by the number of pairs. */
static void shares_are_even_without_contacts(void **state)
{
    (void)state;
    lab l;
    make_floe_rows(&l, 3);
    l.w.n_touching = 0;
    fl_share_active_pairs(&l.w);
    assert_int_equal(l.w.pair_share[0].next, 0);
    for (int32_t t = 0; t < 3; t++) {
        const int32_t many = l.w.pair_share[t].end - l.w.pair_share[t].next;
        assert_true(many >= l.w.n_pair / 3 && many <= l.w.n_pair / 3 + 1);
    }
    assert_int_equal(l.w.pair_share[2].end, l.w.n_pair);
    lab_free(&l);
}

/* Any number of threads, one included. */
static void every_pair_is_evaluated_once(void **state)
{
    (void)state;
    lab l;
    make_floe_rows(&l, 4);
    fl_world *w = &l.w;
    fl_err err = {0};
    uint8_t *touches = fl_alloc(w->n_pair, 1, &err);
    assert_non_null(touches);
    memcpy(touches, w->pair_touches, (size_t)w->n_pair);
    for (int nthreads = 1; nthreads <= 4; nthreads++) {
        for (int32_t c = 0; c < w->n_pair; c++)
            w->pair_touches[c] = 2, w->pair[c].free_travel = -1.0,
            w->pair[c].gap.k[0] = w->pair[c].gap.k[1] = w->pair[c].gap.k[2] = 0.0f, fl_set_next_check(w, c);
        fl_share_active_pairs(w);
#pragma omp parallel num_threads(nthreads)
        fl_evaluate_active_pairs(w, 0.0, 0);
        assert_memory_equal(w->pair_touches, touches, (size_t)w->n_pair);
        for (int32_t t = 0; t < 4; t++) assert_true(w->pair_share[t].next >= w->pair_share[t].end);
    }
    assert_int_equal(w->failed, 0);
    free(touches);
    lab_free(&l);
}

/* The pairs of a sleeping body keep their state. */
static void sleeping_pairs_are_not_evaluated(void **state)
{
    (void)state;
    lab l;
    make_floe_rows(&l, 2);
    fl_world *w = &l.w;
    int32_t sleeping = 0;
    for (int32_t c = 0; c < w->n_pair; c++)
        if (!w->pair[c].touching)
            w->pair[c].free_travel = 1e9, fl_set_next_check(w, c), w->pair_touches[c] = 2, sleeping++;
    assert_true(sleeping > 0);
    fl_share_active_pairs(w);
    fl_evaluate_active_pairs(w, 0.0, 0);
    for (int32_t c = 0; c < w->n_pair; c++)
        sleeping -= w->pair_touches[c] == 2 && w->pair[c].free_travel == 1e9;
    assert_int_equal(sleeping, 0);
    lab_free(&l);
}

/* From -1 to 1. */
static double either(fl_rng *g) { return fl_rng_in(g, -1.0, 1.0); }

/* Two boxes slide along each other, rotate and come nearer, at random.  While the gap of the last evaluation
 * lasts, they do not touch, and it lasts over ways that are longer. */
static void a_gap_lasts_until_it_is_used_up(void **state)
{
    (void)state;
    lab l;
    fl_rng g = fl_rng_of(test_seed(), 7, 0);
    int lasts = 0, far = 0, ends = 0, touches = 0;
    lab_start(&l);
    lab_box(&l, v3(0, 0, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_box(&l, v3(1.002, 0.1, 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0), v3(0, 0, 0));
    lab_make(&l, 1e-5);
    fl_world *w = &l.w;
    const fl_vec3 x0 = w->b.x[1];
    const fl_quat q0 = w->b.q[1];
    for (int k = 0; k < 2000; k++) {
        const double slide = k % 2 ? 0.05 : 1e-4, turn = k % 4 < 2 ? 1e-3 : 1e-5;
        fl_contact found;
        fl_pair p;
        lab_pose(w, 0, v3(0, 0, 0), q_one());
        lab_pose(w, 1, v3(x0.x + 0.001 * either(&g), x0.y, x0.z), q0);
        w->pair[0].free_travel = -1.0, w->pair[0].gap.k[0] = 0.0f;
        fl_evaluate_neighbour_pair(w, 0, 0, NULL, 0.0, 0);
        assert_false(w->pair[0].touching);
        const double gap = w->pair[0].free_travel - w->b.odometer[0] - w->b.odometer[1];
        const fl_vec3 by = v3(0.003 * either(&g), slide * either(&g), slide * either(&g));
        lab_pose(w, 1, v3_add(w->b.x[1], by),
                 q_of_vector(v3(turn * either(&g), turn * either(&g), turn * either(&g))));
        fl_neighbour_pair_expand(w, &w->pair[0], &p);
        const int touch = fl_pair_probe(w, &p, 0.0, &found), kept = fl_pair_keeps_gap(w, 0);
        assert_false(touch && kept);
        lasts += kept, far += kept && v3_norm(by) > 2.0 * gap, ends += !kept, touches += touch;
    }
    assert_true(lasts > 500 && far > 100 && ends > 200 && touches > 200);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_are_even), cmocka_unit_test(shares_are_even_without_contacts),
        cmocka_unit_test(every_pair_is_evaluated_once), cmocka_unit_test(sleeping_pairs_are_not_evaluated),
        cmocka_unit_test(a_gap_lasts_until_it_is_used_up)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
