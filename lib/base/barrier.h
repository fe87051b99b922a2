/* SPDX-License-Identifier: GPL-3.0-or-later */
/* barrier.h -- where the threads of a team wait for each other, inside one parallel region.
 *
 * To send a thread to sleep and wake it takes tens of microseconds, to watch a number change less than one: a
 * thread that waits watches first.  How long is learnt.  On a quiet machine all come within microseconds, and
 * it pays to watch; where others use the processors too, the one that is waited for may not run for
 * milliseconds, and whoever watches keeps it from running.  So every wait that ends while it is watched, or
 * soon after, lets the next be watched a little longer, and one that takes much longer lets it be watched an
 * eighth as long.  No bit of a result depends on that. */
#ifndef FL_BASE_BARRIER_H
#define FL_BASE_BARRIER_H
#include <pthread.h>
#include <stdint.h>

typedef struct {
    int32_t arrived, sleeping; /* threads */
    uint32_t generation;       /* how often */
    int32_t spin_ns;           /* how long is watched [ns] */
    pthread_mutex_t mutex;
    pthread_cond_t condition;
} fl_barrier;

void fl_barrier_make(fl_barrier *g);
void fl_barrier_free(fl_barrier *g);

/* Wait until all n threads have come.  The last one calls alone(arg), unless it is NULL, while the others
 * still wait: what that writes they see. */
void fl_barrier_wait(fl_barrier *g, int n, void (*alone)(void *arg), void *arg);

#endif
