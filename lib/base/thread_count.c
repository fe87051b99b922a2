/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/thread_count.h"
#include <time.h>

/* A window has at least WINDOW_STEPS_MIN steps and takes at least WINDOW_TIME [s].  UNTIMED_PER_TIMED times
 * as many steps follow without timing.  Trials are at most PAUSE_MAX windows apart.  A trial wins if its step
 * time is below GAIN_FACTOR of the present one.  A step time above SLOWER_FACTOR of the
 * reference starts a trial. */
enum { WINDOW_STEPS_MIN = 4, UNTIMED_PER_TIMED = 7, PAUSE_MAX = 32 };
#define WINDOW_TIME 2e-3
#define GAIN_FACTOR 0.97
#define SLOWER_FACTOR 1.5
#define SMOOTHING 0.25 /* weight of a new window in the smoothed step time */

static double now_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

void fl_thread_count_make(fl_thread_count *t, int32_t most, int open)
{
    *t = (fl_thread_count){
        .max = most, .n = most, .adaptive = open && most > 1, .windows_left = 1, .windows_between = 1};
}

void fl_thread_count_begin(fl_thread_count *t)
{
    if (t->adaptive && t->untimed_steps == 0) t->step_start = now_seconds();
}

/* Thread count of a trial in that direction; n where there is none. */
static int32_t candidate_count(const fl_thread_count *t, int32_t way)
{
    if (way < 0) return t->n > 1 ? t->n / 2 : t->n;
    return 2 * t->n < t->max ? 2 * t->n : t->max;
}

/* Starts a trial in the direction opposite to the last one, if there is one. */
static void start_trial(fl_thread_count *t)
{
    const int32_t other = t->last_direction < 0 ? 1 : -1;
    t->direction = candidate_count(t, other) != t->n ? other : -other;
    t->n_before = t->n;
    t->n = candidate_count(t, t->direction);
}

/* Ends a trial whose step took `time` [s]. */
static void end_trial(fl_thread_count *t, double time)
{
    t->last_direction = t->direction;
    if (time < GAIN_FACTOR * t->step_time) {
        t->step_time = t->reference_time = time;
        t->windows_between = 1;
        t->last_direction = -t->direction; /* try the same direction again */
    } else {
        t->n = t->n_before;
        if (t->windows_between < PAUSE_MAX) t->windows_between *= 2;
    }
    t->windows_left = t->windows_between;
    t->direction = 0;
}

void fl_thread_count_update(fl_thread_count *t, double time)
{
    t->untimed_steps = UNTIMED_PER_TIMED * t->timed_steps;
    t->window_time = 0.0;
    t->timed_steps = 0;
    if (t->direction) {
        end_trial(t, time);
        return;
    }
    t->step_time = t->step_time > 0.0 ? t->step_time + SMOOTHING * (time - t->step_time) : time;
    if (!(t->reference_time > 0.0) || t->step_time < t->reference_time) t->reference_time = t->step_time;
    /* one thread waits for no other: a single slow window says little */
    const int slower = (t->n > 1 ? time : t->step_time) > SLOWER_FACTOR * t->reference_time;
    if (!slower && --t->windows_left > 0) return;
    if (slower) t->last_direction = 1, t->windows_between = 1; /* fewer threads first, if possible */
    t->reference_time = t->step_time;
    start_trial(t);
    t->untimed_steps = 0;
}

void fl_thread_count_end(fl_thread_count *t)
{
    t->steps++;
    t->thread_steps += t->n;
    if (!t->adaptive) return;
    if (t->untimed_steps > 0) {
        t->untimed_steps--;
        return;
    }
    t->window_time += now_seconds() - t->step_start;
    if (++t->timed_steps >= WINDOW_STEPS_MIN && t->window_time >= WINDOW_TIME)
        fl_thread_count_update(t, t->window_time / (double)t->timed_steps);
}
