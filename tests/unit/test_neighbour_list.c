/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The travel of bodies reported by groups of floes equals that of all floes: the neighbour search runs when
 * needed. */
#include <string.h>
#include "base/array.h"
#include "base/rng.h"
#include "sim/neighbour_list.h"
#include "support/small_world.h"
#include "support/near.h"

static int descending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* The sum of the two longest travels since the travel counters were found[total]. */
static double longest_travels(const fl_world *w, const double *found)
{
    fl_err err = {0};
    double *way = fl_alloc(w->b.total, sizeof *way, &err);
    assert_non_null(way);
    for (int32_t k = 0; k < w->b.total; k++) way[k] = w->b.odometer[k] - found[k];
    qsort(way, (size_t)w->b.total, sizeof *way, descending);
    const double sum = way[0] + way[1];
    free(way);
    return sum;
}

/* n moving floes, some with equal speeds and in one group. */
static void move_bodies(lab *l, int n, int threads)
{
    lab_start(l);
    lab_setf(l, "run.threads=%d", threads);
    for (int k = 0; k < n; k++) {
        fl_rng g = fl_rng_of(test_seed(), k, FL_RNG_TEST);
        const double u = k % 5 == 0 ? 4.0 : fl_rng_in(&g, 0.0, 3.0);
        lab_box(l, v3(1.5 * (k % 10), 1.5 * (k / 10), 0), v3(0.5, 0.5, 0.2), 0.05, q_one(),
                v3(k % 2 ? u : -u, fl_rng_in(&g, -1.0, 1.0), 0), v3(0, 0, fl_rng_in(&g, -1.0, 1.0)));
    }
    lab_make(l, 2e-4);
}

static void check_travels(int n, int threads)
{
    lab l;
    fl_err err = {0};
    move_bodies(&l, n, threads);
    const fl_world *w = &l.w;
    const double allowed = w->skin * (1.0 - 1e-6);
    double *found = fl_alloc(w->b.total, sizeof *found, &err);
    assert_non_null(found);
    const int64_t searches = w->searches;
    for (int k = 0; k < 600; k++) {
        const int64_t before = w->searches;
        memcpy(found, w->odometer_at_search, (size_t)w->b.total * sizeof *found);
        assert_int_equal(lab_run(&l, 1), 0);
        assert_int_equal(w->searches - before, longest_travels(w, found) >= allowed);
    }
    assert_true(w->searches > searches + 3);
    free(found);
    lab_free(&l);
}

static void the_search_runs_in_time(void **state)
{
    (void)state;
    check_travels(2, 1);
    check_travels(31, 1); /* one group, not complete */
    check_travels(33, 1); /* the last group, of one floe */
    check_travels(100, 3);
}

/* A search without the reported travels gives the same. */
static void group_travels_do_not_change_the_search(void **state)
{
    (void)state;
    lab l;
    fl_err err = {0};
    move_bodies(&l, 70, 1);
    for (int k = 0; k < 200; k++) {
        assert_int_equal(lab_run(&l, 1), 0);
        const int64_t before = l.w.searches;
        assert_int_equal(fl_neighbour_list_update(&l.w, &err), 0);
        assert_int_equal(l.w.searches, before);
    }
    lab_free(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_search_runs_in_time),
                                       cmocka_unit_test(group_travels_do_not_change_the_search)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
