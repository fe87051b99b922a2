/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread_count.h -- how many threads make a step, where the scene leaves that open: as many as are the fastest, which
 * is tried now and then.
 *
 * A second thread takes up to half of the time where there is enough to do and a processor for it; in a small
 * scene it wins nothing, and where other programs are at work a team waits for the one of its threads that
 * does not run, up to twenty times as long as one thread would take.  So steps are timed in short windows:
 * by as many threads as now, and by half or twice as many, which stay where they are faster by a thirtieth.
 * Where nothing changes that is done more and more seldom, down to a step of 250; where a step takes half as
 * long again as it did it is done at once.  No bit of a result depends on how many there are. */
#ifndef FL_BASE_THREAD_COUNT_H
#define FL_BASE_THREAD_COUNT_H
#include <stdint.h>

typedef struct {
    int32_t max;                        /* threads at the most, for which arrays have room */
    int32_t n;                          /* and now */
    int32_t adaptive;                   /* fewer are tried as well */
    int32_t direction;                  /* of a trial: -1 half as many, 1 twice as many; 0: there is none */
    int32_t last_direction;             /* of the trial before */
    int32_t n_before;                   /* n before the trial */
    int64_t timed_steps, untimed_steps; /* steps of the window under way; steps to come before the next */
    int64_t windows_left,
        windows_between; /* windows before the next trial, and between trials as long as none wins */
    double step_start, window_time; /* of the step and the window under way [s] */
    double step_time;               /* what a step by n takes, smoothed [s]; 0: nobody knows yet */
    double reference_time;          /* and took at the trial before, or at its best since */
    int64_t steps, thread_steps;    /* made so far, and the threads that they had, added up */
} fl_thread_count;

void fl_thread_count_make(fl_thread_count *t, int32_t most, int open);

/* A step begins, and ends: t->n is what it is made by, and may be another for the next. */
void fl_thread_count_begin(fl_thread_count *t);
void fl_thread_count_end(fl_thread_count *t);

/* What a step of a window took by t->n, and what that leads to [s]: fl_thread_count_end() calls it when it is due. */
void fl_thread_count_update(fl_thread_count *t, double each);

/* Threads that steps were made by, in the mean. */
static inline double fl_thread_count_mean(const fl_thread_count *t)
{
    return t->steps > 0 ? (double)t->thread_steps / (double)t->steps : t->n;
}

#endif
