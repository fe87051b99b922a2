/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <time.h>
#include "base/barrier.h"

/* [ns] Longest spin, about the cost of falling asleep and waking; increment after a useful spin; length of a
 * wait for which spinning is useless; divisor of the spin time after such a wait.  Measured with 200 bodies
 * and four other busy processes on two processors: a step of two threads takes 2 to 7 times the time of one
 * thread.  With WAIT_LONG = 5 SPIN_MAX and a divisor of 2 it took up to 17 times. */
enum { SPIN_MAX = 20000, SPIN_STEP = 200, WAIT_LONG = 5 * SPIN_MAX, SPIN_DIVISOR = 8 };

/* Number of checks between two readings of the clock. */
enum { CHECKS = 16 };

void fl_barrier_make(fl_barrier *g)
{
    *g = (fl_barrier){.spin_ns = SPIN_MAX};
    pthread_mutex_init(&g->mutex, NULL);
    pthread_cond_init(&g->condition, NULL);
}

void fl_barrier_free(fl_barrier *g)
{
    pthread_mutex_destroy(&g->mutex);
    pthread_cond_destroy(&g->condition);
}

static inline void pause_processor(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("isb");
#endif
}

static int64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int is_open(fl_barrier *g, uint32_t before)
{
    return __atomic_load_n(&g->generation, __ATOMIC_ACQUIRE) != before;
}

/* Spins for spin_ns.  Returns 0 if the barrier is still closed. */
static int spin_until_open(fl_barrier *g, uint32_t before, int64_t start, int spin_ns)
{
    do {
        for (int k = 0; k < CHECKS; k++) {
            if (is_open(g, before)) return 1;
            pause_processor();
        }
    } while (now_ns() - start < spin_ns);
    return 0;
}

static void sleep_until_open(fl_barrier *g, uint32_t before)
{
    pthread_mutex_lock(&g->mutex);
    __atomic_fetch_add(&g->sleeping, 1, __ATOMIC_SEQ_CST);
    while (__atomic_load_n(&g->generation, __ATOMIC_SEQ_CST) == before)
        pthread_cond_wait(&g->condition, &g->mutex);
    __atomic_fetch_sub(&g->sleeping, 1, __ATOMIC_SEQ_CST);
    pthread_mutex_unlock(&g->mutex);
}

static void release_waiting(fl_barrier *g)
{
    __atomic_store_n(&g->arrived, 0, __ATOMIC_RELAXED);
    __atomic_fetch_add(&g->generation, 1, __ATOMIC_SEQ_CST);
    if (__atomic_load_n(&g->sleeping, __ATOMIC_SEQ_CST) == 0) return;
    pthread_mutex_lock(&g->mutex);
    pthread_cond_broadcast(&g->condition);
    pthread_mutex_unlock(&g->mutex);
}

void fl_barrier_wait(fl_barrier *g, int n, void (*alone)(void *arg), void *arg)
{
    const uint32_t before = __atomic_load_n(&g->generation, __ATOMIC_RELAXED);
    if (__atomic_fetch_add(&g->arrived, 1, __ATOMIC_SEQ_CST) == n - 1) {
        if (alone) alone(arg);
        if (n > 1) release_waiting(g);
        else __atomic_store_n(&g->arrived, 0, __ATOMIC_RELAXED);
        return;
    }
    const int64_t start = now_ns();
    int spin_ns = __atomic_load_n(&g->spin_ns, __ATOMIC_RELAXED);
    int wasted = 0;
    if (!spin_until_open(g, before, start, spin_ns)) {
        sleep_until_open(g, before);
        wasted = now_ns() - start > WAIT_LONG;
    }
    spin_ns = wasted                           ? spin_ns / SPIN_DIVISOR
              : spin_ns < SPIN_MAX - SPIN_STEP ? spin_ns + SPIN_STEP
                                               : SPIN_MAX;
    __atomic_store_n(&g->spin_ns, spin_ns, __ATOMIC_RELAXED);
}
