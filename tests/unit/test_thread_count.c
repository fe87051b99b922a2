/* SPDX-License-Identifier: GPL-3.0-or-later */
/* The automatic number of threads of a step, chosen by the measured times of steps. */
#include "support/near.h"
#include "base/thread_count.h"

/* Time of a step: two threads halve it, down to the cost of each thread; busy: cost of waiting for a thread
 * without a processor. */
static double step_time(int32_t n, double work, double busy)
{
    return work / n + 0.02 * n + (n > 1 ? busy : 0.0);
}

static void run_windows(fl_thread_count *t, int many, double work, double busy)
{
    while (many--) fl_thread_count_update(t, step_time(t->n, work, busy));
}

/* The settled number, not that of a trial. */
static int32_t settled_count(fl_thread_count *t, double work, double busy)
{
    for (int k = 0; k < 2000 && t->direction; k++) run_windows(t, 1, work, busy);
    return t->n;
}

static void the_fastest_count_is_found(void **state)
{
    fl_thread_count t;
    (void)state;
    fl_thread_count_make(&t, 16, 1);
    run_windows(&t, 40, 1.28, 0.0); /* 1.30, 0.68, 0.40, 0.32, 0.40 by 1 to 16 */
    assert_int_equal(settled_count(&t, 1.28, 0.0), 8);
    fl_thread_count_make(&t, 2, 1);
    run_windows(&t, 40, 0.01, 0.0);
    assert_int_equal(settled_count(&t, 0.01, 0.0), 1);
    run_windows(&t, 1000, 1.0, 0.0); /* there is more work */
    assert_int_equal(settled_count(&t, 1.0, 0.0), 2);
}

static void a_busy_processor_lowers_the_count(void **state)
{
    fl_thread_count t;
    (void)state;
    fl_thread_count_make(&t, 2, 1);
    run_windows(&t, 1000, 1.0, 0.0);
    assert_int_equal(settled_count(&t, 1.0, 0.0), 2);
    run_windows(&t, 3, 1.0, 10.0); /* one window detects it, and one more tries the next number */
    assert_int_equal(settled_count(&t, 1.0, 10.0), 1);
    run_windows(&t, 2000, 1.0, 0.0);
    assert_int_equal(settled_count(&t, 1.0, 0.0), 2);
}

/* Trials become rare where none is faster: less than one window in thirty. */
static void trials_become_rare(void **state)
{
    fl_thread_count t;
    int tried = 0;
    (void)state;
    fl_thread_count_make(&t, 4, 1);
    run_windows(&t, 2000, 10.0, 0.0);
    for (int k = 0; k < 1000; k++) {
        run_windows(&t, 1, 10.0, 0.0);
        tried += t.direction != 0;
    }
    assert_true(tried > 0 && tried < 34);
}

static void a_given_count_stays(void **state)
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
        cmocka_unit_test(the_fastest_count_is_found), cmocka_unit_test(a_busy_processor_lowers_the_count),
        cmocka_unit_test(trials_become_rare), cmocka_unit_test(a_given_count_stays)};
    return cmocka_run_group_tests_name("thread_count", tests, NULL, NULL);
}
