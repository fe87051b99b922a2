/* SPDX-License-Identifier: GPL-3.0-or-later */
/* How many threads make a step where that is left open, told what a step takes by how many. */
#include "support/near.h"
#include "base/thread_count.h"

/* A second thread halves the time, up to what there is to do, and each costs something; busy: what it costs
 * to wait for one that has no processor. */
static double each(int32_t n, double work, double busy) { return work / n + 0.02 * n + (n > 1 ? busy : 0.0); }

static void windows(fl_thread_count *t, int many, double work, double busy)
{
    while (many--) fl_thread_count_update(t, each(t->n, work, busy));
}

/* Whatever it is at the moment, beside trials. */
static int32_t stays(fl_thread_count *t, double work, double busy)
{
    for (int k = 0; k < 2000 && t->direction; k++) windows(t, 1, work, busy);
    return t->n;
}

static void the_fastest_is_found(void **state)
{
    fl_thread_count t;
    (void)state;
    fl_thread_count_make(&t, 16, 1);
    windows(&t, 40, 1.28, 0.0); /* 1.30, 0.68, 0.40, 0.32, 0.40 by 1 to 16 */
    assert_int_equal(stays(&t, 1.28, 0.0), 8);
    fl_thread_count_make(&t, 2, 1);
    windows(&t, 40, 0.01, 0.0);
    assert_int_equal(stays(&t, 0.01, 0.0), 1);
    windows(&t, 1000, 1.0, 0.0); /* there is more to do */
    assert_int_equal(stays(&t, 1.0, 0.0), 2);
}

static void others_are_made_way_for(void **state)
{
    fl_thread_count t;
    (void)state;
    fl_thread_count_make(&t, 2, 1);
    windows(&t, 1000, 1.0, 0.0);
    assert_int_equal(stays(&t, 1.0, 0.0), 2);
    windows(&t, 3, 1.0, 10.0); /* a window is all it takes to see, and one more to try */
    assert_int_equal(stays(&t, 1.0, 10.0), 1);
    windows(&t, 2000, 1.0, 0.0);
    assert_int_equal(stays(&t, 1.0, 0.0), 2);
}

/* Trials grow rare where none wins: below one window in thirty. */
static void trials_are_rare(void **state)
{
    fl_thread_count t;
    int tried = 0;
    (void)state;
    fl_thread_count_make(&t, 4, 1);
    windows(&t, 2000, 10.0, 0.0);
    for (int k = 0; k < 1000; k++) {
        windows(&t, 1, 10.0, 0.0);
        tried += t.direction != 0;
    }
    assert_true(tried > 0 && tried < 34);
}

static void what_is_asked_for_stays(void **state)
{
    fl_thread_count t;
    (void)state;
    fl_thread_count_make(&t, 8, 0);
    for (int k = 0; k < 100000; k++) fl_thread_count_begin(&t), fl_thread_count_end(&t);
    assert_int_equal(t.n, 8);
    assert_true(fl_thread_count_mean(&t) == 8.0);
    fl_thread_count_make(&t, 1, 1);
    for (int k = 0; k < 100000; k++) fl_thread_count_begin(&t), fl_thread_count_end(&t);
    assert_int_equal(t.n, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fastest_is_found), cmocka_unit_test(others_are_made_way_for),
        cmocka_unit_test(trials_are_rare), cmocka_unit_test(what_is_asked_for_stays)};
    return cmocka_run_group_tests_name("team", tests, NULL, NULL);
}
