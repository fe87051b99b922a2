/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <omp.h>
#include <time.h>
#include "base/barrier.h"
#include "base/work_share.h"
#include "support/near.h"

enum { THREADS = 4, ROUNDS = 2000 };

/* Written by the last thread that arrives. */
typedef struct {
    int called, wrong;
    int came[THREADS]; /* written by each thread before it waits */
} book;

static void check_alone(void *arg)
{
    book *const q = arg;
    q->called++;
    for (int t = 0; t < THREADS; t++) q->wrong += q->came[t] != q->called;
}

/* The callback runs after all threads have arrived, and no thread leaves before it has run. There are more
 * threads than processors, and one is late at times, so that the others sleep. */
static void test_all_wait_for_all(void **state)
{
    (void)state;
    fl_barrier barrier;
    book q = {0};
    int early = 0, team_size = 0;
    fl_barrier_make(&barrier);
#pragma omp parallel num_threads(THREADS) reduction(+ : early)
    {
        const int n = omp_get_num_threads(), t = omp_get_thread_num();
        if (t == 0) team_size = n;
        for (int round = 1; n == THREADS && round <= ROUNDS; round++) {
            if (t == round % THREADS && round % 100 == 0)
                nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
            q.came[t] = round;
            fl_barrier_wait(&barrier, n, check_alone, &q);
            early += q.called != round; /* the next round cannot be recorded before this one is complete */
            fl_barrier_wait(&barrier, n, NULL, NULL);
        }
    }
    fl_barrier_free(&barrier);
    assert_int_equal(team_size, THREADS);
    assert_int_equal(q.called, ROUNDS);
    assert_int_equal(q.wrong, 0);
    assert_int_equal(early, 0);
}

static void add_one(void *arg) { ++*(int *)arg; }

static void test_one_thread_passes_alone(void **state)
{
    (void)state;
    fl_barrier barrier;
    int n = 0;
    fl_barrier_make(&barrier);
    for (int k = 0; k < 3; k++) fl_barrier_wait(&barrier, 1, add_one, &n);
    fl_barrier_wait(&barrier, 1, NULL, NULL);
    fl_barrier_free(&barrier);
    assert_int_equal(n, 3);
}

/* Each number is taken exactly once, for any number of ranges, also with fewer numbers than ranges. */
static void test_every_item_is_taken_once(void **state)
{
    (void)state;
    static const int32_t MANY[] = {0, 1, 3, 16, 1001};
    for (size_t k = 0; k < sizeof MANY / sizeof *MANY; k++) {
        for (int runs = 1; runs <= THREADS; runs++) {
            for (int32_t block = 1; block <= 16; block *= 4) {
                const int32_t n = MANY[k];
                int8_t taken[1001] = {0};
                fl_work_share s[THREADS];
                fl_work_share_split(s, runs, n);
#pragma omp parallel num_threads(THREADS)
                for (int r = 0; r < runs; r++) {
                    fl_work_share *const own = &s[(omp_get_thread_num() + r) % runs];
                    for (int32_t c = fl_work_share_take(own, block); c < own->end;
                         c = fl_work_share_take(own, block))
                        for (int32_t i = c; i < c + block && i < own->end; i++) taken[i]++;
                }
                for (int32_t i = 0; i < n; i++) assert_int_equal(taken[i], 1);
            }
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_wait_for_all),
        cmocka_unit_test(test_one_thread_passes_alone),
        cmocka_unit_test(test_every_item_is_taken_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
