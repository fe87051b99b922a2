/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Near pairs are shared out by the contacts of the step before, and each is looked at, whoever does. */
#include <string.h>
#include "base/mem.h"
#include "step/awake.h"
#include "support/lab.h"
#include "support/near.h"
#include "world/access.h"

/* 144 floes in rows; those of a row touch one another, and are near the rows beside. */
static void rows(lab *l, int threads)
{
    lab_start(l);
    lab_setf(l, "run.threads=%d", threads);
    for (int k = 0; k < 144; k++)
        lab_box(l, v3(0.999 * (k % 12), 1.01 * (k / 12), 0), v3(0.5, 0.5, 0.2), 0.05, q_one(), v3(0, 0, 0),
                v3(0, 0, 0));
    lab_make(l, 1e-5);
    assert_int_equal(l->w.threads, threads);
    assert_true(l->w.n_live >= 12 * 11 && l->w.n_live < l->w.n_pair / 2);
}

/* Contacts in a share, and that shares follow each other over all pairs. */
static void shares_are_even(void **state)
{
    (void)state;
    lab l;
    rows(&l, 5);
    const fl_world *w = &l.w;
    fl_awake_share(&l.w);
    assert_int_equal(w->share[0].next, 0);
    for (int32_t t = 0; t < 5; t++) {
        int32_t many = 0;
        for (int32_t k = 0; k < w->n_live; k++)
            many += w->live[k] >= w->share[t].next && w->live[k] < w->share[t].end;
        assert_true(many == w->n_live / 5 || many == w->n_live / 5 + 1);
        assert_int_equal(w->share[t].end, t < 4 ? w->share[t + 1].next : w->n_pair);
    }
    lab_free(&l);
}

/* Before anything touches, pairs count. */
static void without_contacts_too(void **state)
{
    (void)state;
    lab l;
    rows(&l, 3);
    l.w.n_live = 0;
    fl_awake_share(&l.w);
    assert_int_equal(l.w.share[0].next, 0);
    for (int32_t t = 0; t < 3; t++) {
        const int32_t many = l.w.share[t].end - l.w.share[t].next;
        assert_true(many >= l.w.n_pair / 3 && many <= l.w.n_pair / 3 + 1);
    }
    assert_int_equal(l.w.share[2].end, l.w.n_pair);
    lab_free(&l);
}

/* A team of any size, of one too. */
static void all_are_looked_at(void **state)
{
    (void)state;
    lab l;
    rows(&l, 4);
    fl_world *w = &l.w;
    fl_err err = {0};
    uint8_t *hit = fl_alloc(w->n_pair, 1, &err);
    assert_non_null(hit);
    memcpy(hit, w->hit, (size_t)w->n_pair);
    for (int team = 1; team <= 4; team++) {
        for (int32_t c = 0; c < w->n_pair; c++) w->hit[c] = 2, w->pair[c].asleep = -1.0, fl_world_watch(w, c);
        fl_awake_share(w);
#pragma omp parallel num_threads(team)
        fl_awake_look(w, 0.0, 0);
        assert_memory_equal(w->hit, hit, (size_t)w->n_pair);
        for (int32_t t = 0; t < 4; t++) assert_true(w->share[t].next >= w->share[t].end);
    }
    assert_int_equal(w->failed, 0);
    free(hit);
    lab_free(&l);
}

/* Who sleeps stays as it is. */
static void sleepers_are_left_alone(void **state)
{
    (void)state;
    lab l;
    rows(&l, 2);
    fl_world *w = &l.w;
    int32_t slept = 0;
    for (int32_t c = 0; c < w->n_pair; c++)
        if (!w->pair[c].n) w->pair[c].asleep = 1e9, fl_world_watch(w, c), w->hit[c] = 2, slept++;
    assert_true(slept > 0);
    fl_awake_share(w);
    fl_awake_look(w, 0.0, 0);
    for (int32_t c = 0; c < w->n_pair; c++) slept -= w->hit[c] == 2 && w->pair[c].asleep == 1e9;
    assert_int_equal(slept, 0);
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shares_are_even), cmocka_unit_test(without_contacts_too),
        cmocka_unit_test(all_are_looked_at), cmocka_unit_test(sleepers_are_left_alone)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
