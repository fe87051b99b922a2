/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The layout of a state, and the checkpoint version that identifies it. */
#include "support/near.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "out/restart.h"
#include "sim/error_budget.h"
#include "sim/snapshot.h"
#include "support/scenes.h"

/* Name and number of words of each kind of row. A pair with stored vertices has their count before them. A
 * touching pair also has its forces, and the rolling springs of a sphere: "pair" is a pair with neither, in a
 * periodic domain or not, or with the last. With surrogates a touching pair states whether it has been
 * evaluated, and then its surrogate. A bond has its points once it is damaged. */
static const char LAYOUT[] =
    "ball 13|ball 21|ball 24|beside 6|body 26|body 27|bond 36|bond 81|bonds 9|books 35|borne 15|"
    "broken 10|budget 15|crushed 5|damped 10|dents 2|disc 28|event 15|flow 8|joint 134|known 6|link 4|"
    "load 2|mark 16|mover 40|nap 13|next 2|node 16|pair 105|pair 106|pair 33|pair 34|pair 35|pair 36|"
    "pair 37|pair 40|pair 41|pair 44|pair 50|panel 5|part 8|pin 25|place 6|place 7|pressed 5|sea 26|sea "
    "38|sea 6|seam 2|"
    "share 10|shared 2|stage 9|told 5|traffic 14|window 9|world 17|zones 6|";
enum { LAYOUT_IS_OF = 19, KINDS = 64 };

typedef struct {
    char row[KINDS][24];
    int n;
} rows;

static int by_name(const void *a, const void *b) { return strcmp(a, b); }

static void note_row(rows *all, const char *name, int words)
{
    char row[24];
    snprintf(row, sizeof row, "%.15s %d|", name, words);
    for (int k = 0; k < all->n; k++)
        if (strcmp(all->row[k], row) == 0) return;
    assert_true(all->n < KINDS);
    memcpy(all->row[all->n++], row, sizeof row);
}

static void collect_rows(rows *all, char *text, size_t n, int wraps)
{
    enum { FORCES = 9 * 3 + 5, WORDS = 64 };
    fl_text in = {0};
    fl_err err = {0};
    int more;
    assert_int_equal(fl_text_open_bytes(&in, "state", text, (int64_t)n, &err), 0);
    while ((more = fl_text_row(&in, &err)) > 0) {
        const int images = wraps ? 3 : 0;
        char name[16];
        int words = (int)in.n;
        snprintf(name, sizeof name, "%s", in.field[0]);
        if (strcmp(name, "pair") == 0) {
            words -= 2 * atoi(in.field[10 + images]);
            if (atoi(in.field[3 + images])) words -= FORCES;
        }
        note_row(all, name, words);
    }
    assert_int_equal(more, 0);
    fl_text_close(&in);
    free(text);
}

static void collect_state(rows *all, lab *l, int wraps)
{
    char *text = NULL;
    size_t n = 0;
    lab_make(l, 0);
    assert_int_equal(lab_run(l, 12), 0);
    FILE *f = open_memstream(&text, &n);
    fl_snapshot_write(f, &l->w);
    fclose(f);
    collect_rows(all, text, n, wraps);
    lab_free(l);
}

static void collect_budget(rows *all)
{
    fl_total_load loads[2] = {{.peak = 0.0}};
    fl_error_budget g = {.trial = {.parts = 3},
                         .window_rows = 1,
                         .min_row_steps = 1,
                         .windows = 1,
                         .companion = {.world = {.parts = 1}, .run_load = &loads[0], .own_load = &loads[1]}};
    g.window[0] = (fl_error_window){.h = 1.0, .order = 1.0, .momentum_order = 1.0};
    double known[5] = {0};
    char *text = NULL;
    size_t n = 0;
    g.known_momentum = known;
    FILE *f = open_memstream(&text, &n);
    fl_error_budget_write(f, &g);
    fclose(f);
    collect_rows(all, text, n, 0);
}

/* Where steps of a trial failed its error is infinite, and is read back so. */
static void a_budget_of_failed_trials_comes_back(void **state)
{
    fl_error_budget g = {.trial = {.parts = 3}, .window_rows = 1, .min_row_steps = 1, .windows = 1},
                    back = {.trial = {.parts = 3}};
    double known[5] = {0}, read[5] = {0};
    char *text = NULL;
    size_t n = 0;
    fl_text in = {0};
    fl_err err = {0};
    (void)state;
    g.window[0] = (fl_error_window){
        .h = 1.0, .order = 1.0, .momentum_order = 1.0, .error = INFINITY, .momentum_error = 0.5};
    g.known_momentum = known, back.known_momentum = read;
    FILE *f = open_memstream(&text, &n);
    fl_error_budget_write(f, &g);
    fclose(f);
    assert_int_equal(fl_text_open_bytes(&in, "state", text, (int64_t)n, &err), 0);
    assert_int_equal(fl_error_budget_read(&back, &in, &err), 0);
    assert_true(back.window[0].error == INFINITY && back.window[0].momentum_error == 0.5);
    fl_text_close(&in);
    free(text);
}

/* A change of the layout raises FL_RESTART_VERSION, and both are recorded here. */
static void each_layout_has_a_version_number(void **state)
{
    static rows all;
    char found[KINDS * 24] = "";
    lab l;
    (void)state;
    scene_of_everything(&l, 2, NULL), lab_set(&l, "run.sleep=1e-3"), collect_state(&all, &l, 0);
    scene_of_seas(&l, 2, NULL), collect_state(&all, &l, 0);
    scene_of_sea_interval(&l, 2, NULL), collect_state(&all, &l, 0);
    scene_of_inflow(&l, 2, NULL), collect_state(&all, &l, 0);
    scene_of_periodic_cell(&l, 3, NULL), collect_state(&all, &l, 1);
    scene_of_spheres(&l, 3, NULL), collect_state(&all, &l, 1);
    scene_of_spheres(&l, 3, NULL), lab_set(&l, "boundary.type=rigid rigid rigid"), collect_state(&all, &l, 0);
    scene_of_bonds(&l, 3, NULL), collect_state(&all, &l, 1);
    scene_of_sheet(&l, 3, NULL), collect_state(&all, &l, 0);
    scene_of_endless_sheet(&l, 3, NULL), collect_state(&all, &l, 0);
    scene_of_joints(&l, 3, NULL), collect_state(&all, &l, 0);
    scene_of_stages(&l, 2, NULL), lab_set(&l, "run.relax=adaptive"), lab_set(&l, "zones.size=0.5"),
        lab_set(&l, "zones.law=mohr-coulomb"), lab_set(&l, "material.ice.cohesion=1e5"),
        lab_set(&l, "material.ice.friction_angle=30"), collect_state(&all, &l, 0);
    scene_of_surrogates(&l, 2, NULL), collect_state(&all, &l, 0);
    scene_of_joined_parts(&l, 2, NULL), collect_state(&all, &l, 0);
    scene_of_failing_floes(&l, 2, NULL), collect_state(&all, &l, 0);
    collect_budget(&all);
    qsort(all.row, (size_t)all.n, sizeof *all.row, by_name);
    for (int k = 0; k < all.n; k++) strcat(found, all.row[k]);
    assert_string_equal(found, LAYOUT);
    assert_int_equal(FL_RESTART_VERSION, LAYOUT_IS_OF);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_layout_has_a_version_number),
                                       cmocka_unit_test(a_budget_of_failed_trials_comes_back)};
    return cmocka_run_group_tests_name("snapshot", tests, NULL, NULL);
}
