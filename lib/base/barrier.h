/* SPDX-License-Identifier: GPL-3.0-or-later */
/* barrier.h -- barrier for the threads of one parallel region: spin first, then sleep.
 *
 * Sleeping and waking cost tens of microseconds, spinning on a variable less than one, so a waiting thread
 * spins first.  The spin time adapts.  On a quiet machine all threads arrive within microseconds and spinning
 * pays.  On a busy machine the awaited thread may not run for milliseconds, and a spinning thread keeps it
 * from running.  A wait that ends during the spin or soon after lengthens the next spin slightly; a much
 * longer wait divides it by eight.  Results do not depend on the spin time. */
#ifndef FL_BASE_BARRIER_H
#define FL_BASE_BARRIER_H
#include <pthread.h>
#include <stdint.h>

typedef struct {
    int32_t arrived, sleeping; /* numbers of threads */
    uint32_t generation;       /* number of releases */
    int32_t spin_ns;           /* present spin time [ns] */
    pthread_mutex_t mutex;
    pthread_cond_t condition;
} fl_barrier;

void fl_barrier_make(fl_barrier *g);
void fl_barrier_free(fl_barrier *g);

/* Waits until all n threads have arrived.  The last one calls alone(arg), unless NULL, while the others still
 * wait; they see what it writes. */
void fl_barrier_wait(fl_barrier *g, int n, void (*alone)(void *arg), void *arg);

#endif
