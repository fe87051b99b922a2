/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/thread_count.h"
#include <time.h>

/* A window has so many steps at least, and so long [s]; RESTS times as many that nobody times come after it.
 * Trials are LONGEST windows apart at the most.  A trial is held against BETTER of what is, a step that takes
 * WORSE of what it did asks for one. */
enum { LEAST = 4, RESTS = 7, LONGEST = 32 };
#define WINDOW 2e-3
#define BETTER 0.97
#define WORSE 1.5
#define SMOOTH 0.25 /* of a window counts for the next */

static double now(void)
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
    if (t->adaptive && t->untimed_steps == 0) t->step_start = now();
}

/* By how many a trial that way would be; n where there are none. */
static int32_t tried(const fl_thread_count *t, int32_t way)
{
    if (way < 0) return t->n > 1 ? t->n / 2 : t->n;
    return 2 * t->n < t->max ? 2 * t->n : t->max;
}

/* The other way than the last, if there is one. */
static void try_another(fl_thread_count *t)
{
    const int32_t other = t->last_direction < 0 ? 1 : -1;
    t->direction = tried(t, other) != t->n ? other : -other;
    t->n_before = t->n;
    t->n = tried(t, t->direction);
}

/* A trial took `each` a step. */
static void judge(fl_thread_count *t, double each)
{
    t->last_direction = t->direction;
    if (each < BETTER * t->step_time) {
        t->step_time = t->reference_time = each;
        t->windows_between = 1;
        t->last_direction = -t->direction; /* the same way once more */
    } else {
        t->n = t->n_before;
        if (t->windows_between < LONGEST) t->windows_between *= 2;
    }
    t->windows_left = t->windows_between;
    t->direction = 0;
}

void fl_thread_count_update(fl_thread_count *t, double each)
{
    t->untimed_steps = RESTS * t->timed_steps;
    t->window_time = 0.0;
    t->timed_steps = 0;
    if (t->direction) {
        judge(t, each);
        return;
    }
    t->step_time = t->step_time > 0.0 ? t->step_time + SMOOTH * (each - t->step_time) : each;
    if (!(t->reference_time > 0.0) || t->step_time < t->reference_time) t->reference_time = t->step_time;
    /* one thread waits for nobody: a window that takes long tells little of it */
    const int slower = (t->n > 1 ? each : t->step_time) > WORSE * t->reference_time;
    if (!slower && --t->windows_left > 0) return;
    if (slower) t->last_direction = 1, t->windows_between = 1; /* fewer, if there may be */
    t->reference_time = t->step_time;
    try_another(t);
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
    t->window_time += now() - t->step_start;
    if (++t->timed_steps >= LEAST && t->window_time >= WINDOW)
        fl_thread_count_update(t, t->window_time / (double)t->timed_steps);
}
