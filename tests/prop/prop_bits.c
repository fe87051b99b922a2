/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Equal bits: a scene with all features, for any number of threads, neighbour searches, stop and resume,
 * and order and numbers of bodies. */
#define _GNU_SOURCE /* open_memstream */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "support/near.h"
#include "scene/ice_field_order.h"
#include "contact/bond_list.h"
#include "sim/snapshot.h"
#include "support/bits.h"
#include "support/scenes.h"

/* Variants of one run. */
typedef struct {
    int32_t threads, every; /* every: steps between searches, 0: when the skin is used up */
    double skin;            /* factor on it */
    int64_t stop;           /* resumed in another world from this step on; 0: never */
    int32_t then;           /* threads of that world */
    int other;              /* bodies are listed in reverse order, with other numbers */
} variant;

/* The run: a scene with a number of bodies per side, under a law. */
typedef struct {
    void (*scene)(lab *l, int32_t side, const char *law);
    int32_t side;
    const char *law;
} case_of_run;

#define SWAP(T, a, i, j)                                                                                     \
    do {                                                                                                     \
        const T swap = (a)[i];                                                                               \
        (a)[i] = (a)[j], (a)[j] = swap;                                                                      \
    } while (0)

static void renumber(fl_ice_field *a)
{
    for (int32_t i = 0; i < a->n; i++) a->id[i] = 100000 - 3 * a->id[i];
    for (int32_t i = 0, j = a->n - 1; i < j; i++, j--) {
        SWAP(int32_t, a->id, i, j);
        SWAP(int32_t, a->material, i, j);
        SWAP(int32_t, a->group, i, j);
        SWAP(double, a->radius, i, j);
        SWAP(fl_poly, a->core, i, j);
        SWAP(fl_vec3, a->velocity, i, j);
        SWAP(fl_vec3, a->spin, i, j);
    }
    for (int32_t k = 0; k < a->bonds; k++) { /* sorted by fl_ice_field_order() */
        fl_ice_field_bond *d = &a->bond[k];
        d->i = a->n - 1 - d->i, d->j = a->n - 1 - d->j;
    }
}

static void make(lab *l, const variant *how, int32_t threads, const case_of_run *it)
{
    fl_err err = {0};
    it->scene(l, it->side, it->law);
    int32_t *at = calloc((size_t)l->field.n, sizeof *at);
    assert_non_null(at);
    if (how->other) renumber(&l->field);
    assert_int_equal(fl_ice_field_order(&l->field, at, &err), 0); /* as dem-solve does */
    free(at);
    lab_setf(l, "run.threads=%d", threads);
    if (how->every) lab_setf(l, "run.search_every=%d", how->every);
    lab_make(l, 0);
    l->w.skin *= how->skin;
    l->w.last_search_step = -1; /* the present list belongs to the other skin */
}

static uint64_t run(const variant *how, const case_of_run *it, int64_t steps, int64_t *touching,
                    int64_t *searches)
{
    lab l, m;
    fl_err err = {0};
    fl_text in = {0};
    char *text = NULL;
    size_t n = 0;
    make(&l, how, how->threads, it);
    if (it->side == 8) assert_int_equal(l.w.threads, how->threads);
    assert_int_equal(lab_run(&l, how->stop ? how->stop : steps), 0);
    if (how->stop) {
        FILE *f = open_memstream(&text, &n);
        assert_non_null(f);
        fl_snapshot_write(f, &l.w);
        assert_int_equal(fclose(f), 0);
        make(&m, how, how->then, it);
        assert_int_equal(fl_text_open_bytes(&in, "snapshot", text, (int64_t)n, &err), 0);
        assert_int_equal(fl_snapshot_read(&m.w, &in, &err), 0);
        fl_text_close(&in);
        free(text);
        lab_free(&l);
        l = m;
        assert_int_equal(lab_run(&l, steps - how->stop), 0);
    }
    const uint64_t got = bits_of(&l.w);
    if (it->scene == scene_of_inflow) assert_true(l.w.inflow.n_entered > 0 && l.w.inflow.n_left > 0);
    if (it->scene == scene_of_bonds && steps >= 200) {
        const fl_bond_counts c = fl_bond_list_counts(&l.w);
        assert_true(c.state[FL_BOND_DAMAGED] > 0 && c.state[FL_BOND_BROKEN] > 0 &&
                    c.state[FL_BOND_ENDED] > 0);
    }
    if (it->scene == scene_of_surrogates)
        assert_true(10 * fl_surrogate_count_sum(l.w.surrogate_counts, l.w.threads).hits > l.w.contact_steps);
    *touching = l.w.contact_steps;
    *searches = l.w.searches;
    lab_free(&l);
    return got;
}

static void compare(const variant *how, int ways, const case_of_run *it, int64_t steps, int64_t at_least)
{
    uint64_t first = 0;
    int64_t touching, searches, fewest = INT64_MAX, most = 0;
    for (int k = 0; k < ways; k++) {
        const uint64_t got = run(&how[k], it, steps, &touching, &searches);
        if (k == 0) first = got;
        if (got != first) print_error("law %s: variant %d has other bits\n", it->law, k);
        assert_true(got == first);
        assert_true(touching > at_least);
        fewest = searches < fewest ? searches : fewest;
        most = searches > most ? searches : most;
    }
    /* the numbers of searches must differ, except for searches that every inflowing floe and every broken
     * bond causes */
    assert_true(most > (it->scene == scene_of_inflow || it->scene == scene_of_inflow_interval ||
                                it->scene == scene_of_bonds || it->scene == scene_of_sheet
                            ? 1
                            : 4) *
                           fewest);
}

/* 512 bodies: enough for 16 threads. */
static void threads_and_searches(void **state)
{
    const variant how[] = {{1, 0, 1.0, 0, 0, 0},  {2, 0, 1.0, 0, 0, 0},  {3, 7, 1.0, 0, 0, 0},
                           {8, 0, 0.2, 0, 0, 0},  {16, 0, 3.0, 0, 0, 0}, {2, 0, 1.0, 3, 16, 0},
                           {16, 1, 1.0, 7, 3, 0}, {3, 0, 0.3, 1, 8, 0},  {8, 0, 1.0, 0, 0, 1}};
    const variant few[] = {
        {1, 0, 1.0, 0, 0, 0}, {16, 0, 0.2, 0, 0, 0}, {16, 1, 1.0, 7, 3, 0}, {3, 0, 1.0, 0, 0, 1}};
    const case_of_run it[] = {{scene_of_everything, 8, "patch"}, {scene_of_periodic_cell, 8, "patch"},
                              {scene_of_inflow, 8, "patch"},     {scene_of_spheres, 8, "patch"},
                              {scene_of_bonds, 8, "patch"},      {scene_of_sheet, 6, "patch"}};
    (void)state;
    compare(how, sizeof how / sizeof *how, &it[0], 10, 2000);
    for (int k = 1; k < 5; k++) compare(few, sizeof few / sizeof *few, &it[k], 10, k < 4 ? 2000 : 200);
    compare(few, sizeof few / sizeof *few, &it[5], 200, 100);
}

static void laws(void **state)
{
    static const case_of_run IT[] = {
        {scene_of_everything, 3, "patch"},   {scene_of_everything, 3, "core"},
        {scene_of_everything, 3, "manual"},  {scene_of_everything, 3, "manual-si"},
        {scene_of_everything, 3, "quick"},   {scene_of_bonds, 3, "quick"},
        {scene_of_inflow, 3, "quick"},       {scene_of_periodic_cell, 3, "patch"},
        {scene_of_seas, 3, "patch"},         {scene_of_inflow, 3, "patch"},
        {scene_of_spheres, 3, "patch"},      {scene_of_bonds, 3, "patch"},
        {scene_of_bonds, 3, "manual"},       {scene_of_water_interval, 3, "patch"},
        {scene_of_sea_interval, 3, "patch"}, {scene_of_inflow_interval, 3, "patch"},
        {scene_of_surrogates, 3, "patch"},   {scene_of_surrogates, 3, "quick"},
        {scene_of_sheet, 3, "patch"}};
    const variant how[] = {{1, 0, 1.0, 0, 0, 0}, {2, 5, 1.0, 0, 0, 0}, {1, 0, 0.1, 0, 0, 0},
                           {2, 0, 4.0, 0, 0, 0}, {1, 1, 1.0, 0, 0, 0}, {2, 0, 1.0, 57, 1, 0},
                           {1, 0, 1.0, 0, 0, 1}};
    (void)state;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++)
        compare(how, sizeof how / sizeof *how, &IT[k], 200, 1000);
}

/* One to three threads, changing in each step, against one thread. */
static void changing_thread_counts(void **state)
{
    static const struct {
        void (*scene)(lab *l, int32_t side, const char *law);
        const char *key;
    } IT[] = {{scene_of_everything, "run.sleep=1e-3"}, {scene_of_everything, "run.sleep=none"},
              {scene_of_spheres, "contact.law=patch"}, {scene_of_bonds, "contact.law=patch"},
              {scene_of_sheet, "contact.law=patch"},   {scene_of_surrogates, "contact.law=patch"}};
    (void)state;
    for (size_t k = 0; k < sizeof IT / sizeof *IT; k++) {
        uint64_t bits[2];
        for (int changes = 0; changes < 2; changes++) {
            lab l;
            IT[k].scene(&l, 6, "patch");
            lab_set(&l, IT[k].key);
            lab_setf(&l, "run.threads=%d", changes ? 3 : 1);
            lab_make(&l, 0);
            for (int s = 0; s < 120; s++) {
                l.w.team.n = changes ? 1 + 7 * s % 3 : 1;
                assert_int_equal(lab_run(&l, 1), 0);
            }
            bits[changes] = bits_of(&l.w);
            lab_free(&l);
        }
        assert_true(bits[0] == bits[1]);
    }
}

/* With an argument, prints the bits alone, for prop_width. */
int main(int argc, char **argv)
{
    char text[BITS_TEXT];
    if (argc > 1 && strcmp(argv[1], "--bits") == 0) {
        bits_of_scenes(text);
        return fputs(text, stdout) == EOF;
    }
    const struct CMUnitTest tests[] = {cmocka_unit_test(threads_and_searches), cmocka_unit_test(laws),
                                       cmocka_unit_test(changing_thread_counts)};
    return cmocka_run_group_tests_name("bits", tests, NULL, NULL);
}
