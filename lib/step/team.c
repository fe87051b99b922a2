/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step/team.h"
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

void fl_team_make(fl_team *t, int32_t most, int open)
{
    *t = (fl_team){.most = most, .n = most, .open = open && most > 1, .left = 1, .pause = 1};
}

void fl_team_begin(fl_team *t)
{
    if (t->open && t->rests == 0) t->begun = now();
}

/* By how many a trial that way would be; n where there are none. */
static int32_t tried(const fl_team *t, int32_t way)
{
    if (way < 0) return t->n > 1 ? t->n / 2 : t->n;
    return 2 * t->n < t->most ? 2 * t->n : t->most;
}

/* The other way than the last, if there is one. */
static void try_another(fl_team *t)
{
    const int32_t other = t->last < 0 ? 1 : -1;
    t->way = tried(t, other) != t->n ? other : -other;
    t->was = t->n;
    t->n = tried(t, t->way);
}

/* A trial took `each` a step. */
static void judge(fl_team *t, double each)
{
    t->last = t->way;
    if (each < BETTER * t->each) {
        t->each = t->known = each;
        t->pause = 1;
        t->last = -t->way; /* the same way once more */
    } else {
        t->n = t->was;
        if (t->pause < LONGEST) t->pause *= 2;
    }
    t->left = t->pause;
    t->way = 0;
}

void fl_team_timed(fl_team *t, double each)
{
    t->rests = RESTS * t->timed;
    t->spent = 0.0;
    t->timed = 0;
    if (t->way) {
        judge(t, each);
        return;
    }
    t->each = t->each > 0.0 ? t->each + SMOOTH * (each - t->each) : each;
    if (!(t->known > 0.0) || t->each < t->known) t->known = t->each;
    /* one thread waits for nobody: a window that takes long tells little of it */
    const int slower = (t->n > 1 ? each : t->each) > WORSE * t->known;
    if (!slower && --t->left > 0) return;
    if (slower) t->last = 1, t->pause = 1; /* fewer, if there may be */
    t->known = t->each;
    try_another(t);
    t->rests = 0;
}

void fl_team_end(fl_team *t)
{
    t->steps++;
    t->all += t->n;
    if (!t->open) return;
    if (t->rests > 0) {
        t->rests--;
        return;
    }
    t->spent += now() - t->begun;
    if (++t->timed >= LEAST && t->spent >= WINDOW) fl_team_timed(t, t->spent / (double)t->timed);
}
