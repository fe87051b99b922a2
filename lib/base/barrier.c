/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <time.h>
#include "base/barrier.h"

/* Nanoseconds: what is watched at the most, about what it takes to fall asleep and wake; by how much that
 * grows when it was worth it; a wait of what length was not, and by what it is divided then.  With 200
 * floes and four other busy processes on two processors a step of two threads takes 2 to 7 times as long
 * as one of one thread; at five times MOST, halved, it was up to 17 times. */
enum { MOST = 20000, MORE = 200, LONG = 5 * MOST, LESS = 8 };

/* Looks between two at the clock. */
enum { LOOKS = 16 };

void fl_barrier_make(fl_barrier *g)
{
    *g = (fl_barrier){.spin_ns = MOST};
    pthread_mutex_init(&g->mutex, NULL);
    pthread_cond_init(&g->condition, NULL);
}

void fl_barrier_free(fl_barrier *g)
{
    pthread_mutex_destroy(&g->mutex);
    pthread_cond_destroy(&g->condition);
}

static inline void pause_briefly(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ volatile("isb");
#endif
}

static int64_t now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static int is_open(fl_barrier *g, uint32_t before)
{
    return __atomic_load_n(&g->generation, __ATOMIC_ACQUIRE) != before;
}

/* 0: it is still closed after `patience`. */
static int watch(fl_barrier *g, uint32_t before, int64_t start, int patience)
{
    do {
        for (int k = 0; k < LOOKS; k++) {
            if (is_open(g, before)) return 1;
            pause_briefly();
        }
    } while (now() - start < patience);
    return 0;
}

static void sleep_until(fl_barrier *g, uint32_t before)
{
    pthread_mutex_lock(&g->mutex);
    __atomic_fetch_add(&g->sleeping, 1, __ATOMIC_SEQ_CST);
    while (__atomic_load_n(&g->generation, __ATOMIC_SEQ_CST) == before)
        pthread_cond_wait(&g->condition, &g->mutex);
    __atomic_fetch_sub(&g->sleeping, 1, __ATOMIC_SEQ_CST);
    pthread_mutex_unlock(&g->mutex);
}

static void open_up(fl_barrier *g)
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
        if (n > 1) open_up(g);
        else __atomic_store_n(&g->arrived, 0, __ATOMIC_RELAXED);
        return;
    }
    const int64_t start = now();
    int patience = __atomic_load_n(&g->spin_ns, __ATOMIC_RELAXED);
    int wasted = 0;
    if (!watch(g, before, start, patience)) {
        sleep_until(g, before);
        wasted = now() - start > LONG;
    }
    patience = wasted ? patience / LESS : patience < MOST - MORE ? patience + MORE : MOST;
    __atomic_store_n(&g->spin_ns, patience, __ATOMIC_RELAXED);
}
