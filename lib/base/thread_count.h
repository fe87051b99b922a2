/* SPDX-License-Identifier: GPL-3.0-or-later */
/* thread_count.h -- chooses the number of threads of a step by measurement, where the scene leaves it open.
 *
 * A second thread saves up to half of the time if there is enough work and a free processor.  In a small
 * scene it gains nothing.  On a busy machine a team waits for the thread that does not run, up to twenty
 * times the step time of one thread.  Steps are therefore timed in short windows, with the present number of
 * threads and with half or twice as many; a change is kept if it is faster by a thirtieth.  While nothing
 * changes, trials become rarer, down to one step in 250.  A step that takes half as long again as before
 * starts a trial at once.  Results do not depend on the number of threads. */
#ifndef FL_BASE_THREAD_COUNT_H
#define FL_BASE_THREAD_COUNT_H
#include <stdint.h>

typedef struct {
    int32_t max;                        /* largest number of threads, for which arrays are allocated */
    int32_t n;                          /* present number */
    int32_t adaptive;                   /* smaller numbers are tried as well */
    int32_t direction;                  /* of the trial: -1 half as many, 1 twice as many, 0 no trial */
    int32_t last_direction;             /* of the trial before */
    int32_t n_before;                   /* n before the trial */
    int64_t timed_steps, untimed_steps; /* steps of the present window; steps until the next window */
    int64_t windows_left,
        windows_between; /* windows until the next trial; between trials, doubled while none wins */
    double step_start, window_time; /* start of the step, time of the window [s] */
    double step_time;               /* smoothed step time with n threads [s]; 0: unknown */
    double reference_time;          /* step time at the last trial, or the best since [s] */
    int64_t steps, thread_steps;    /* number of steps, and sum of their thread counts */
} fl_thread_count;

void fl_thread_count_make(fl_thread_count *t, int32_t most, int open);

/* Call at the start and the end of a step.  The step uses t->n threads; the end may change t->n. */
void fl_thread_count_begin(fl_thread_count *t);
void fl_thread_count_end(fl_thread_count *t);

/* Evaluates the mean step time [s] of a window; fl_thread_count_end() calls it when a window is complete. */
void fl_thread_count_update(fl_thread_count *t, double each);

/* Mean number of threads per step. */
static inline double fl_thread_count_mean(const fl_thread_count *t)
{
    return t->steps > 0 ? (double)t->thread_steps / (double)t->steps : t->n;
}

#endif
