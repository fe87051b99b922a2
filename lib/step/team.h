/* SPDX-License-Identifier: GPL-3.0-or-later */
/* team.h -- how many threads make a step, where the scene leaves that open: as many as are the fastest, which
 * is tried now and then.
 *
 * A second thread takes up to half of the time where there is enough to do and a processor for it; in a small
 * scene it wins nothing, and where other programs are at work a team waits for the one of its threads that
 * does not run, up to twenty times as long as one thread would take.  So steps are timed in short windows:
 * by as many threads as now, and by half or twice as many, which stay where they are faster by a thirtieth.
 * Where nothing changes that is done more and more seldom, down to a step of 250; where a step takes half as
 * long again as it did it is done at once.  No bit of a result depends on how many there are. */
#ifndef FL_STEP_TEAM_H
#define FL_STEP_TEAM_H
#include <stdint.h>

typedef struct {
    int32_t most;         /* threads at the most, for which arrays have room */
    int32_t n;            /* and now */
    int32_t open;         /* fewer are tried as well */
    int32_t way;          /* of a trial: -1 half as many, 1 twice as many; 0: there is none */
    int32_t last;         /* of the trial before */
    int32_t was;          /* n before the trial */
    int64_t timed, rests; /* steps of the window under way; steps to come before the next */
    int64_t left, pause;  /* windows before the next trial, and between trials as long as none wins */
    double begun, spent;  /* of the step and the window under way [s] */
    double each;          /* what a step by n takes, smoothed [s]; 0: nobody knows yet */
    double known;         /* and took at the trial before, or at its best since */
    int64_t steps, all;   /* made so far, and the threads that they had, added up */
} fl_team;

void fl_team_make(fl_team *t, int32_t most, int open);

/* A step begins, and ends: t->n is what it is made by, and may be another for the next. */
void fl_team_begin(fl_team *t);
void fl_team_end(fl_team *t);

/* What a step of a window took by t->n, and what that leads to [s]: fl_team_end() calls it when it is due. */
void fl_team_timed(fl_team *t, double each);

/* Threads that steps were made by, in the mean. */
static inline double fl_team_mean(const fl_team *t)
{
    return t->steps > 0 ? (double)t->all / (double)t->steps : t->n;
}

#endif
