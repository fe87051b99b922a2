/* SPDX-License-Identifier: GPL-3.0-or-later */
/* told.h -- the forces of contacts that have hardly moved, as their surrogates tell them, several at a time:
 * one array a number, each contact in a lane of its own, whose bits do not hang on what is beside it. */
#ifndef FL_STEP_TOLD_H
#define FL_STEP_TOLD_H
#include "step/press.h"
#include "world/world.h"

/* Whether contact p may be told of: it has been looked at, and nobody wants to know its places. */
static inline int fl_told_of(const fl_world *w, const fl_pair *p)
{
    return p->n && p->surrogate && p->surrogate->live && !fl_press_wants(w, p);
}

/* n <= FL_TOLD contacts that may be told of, over a step of dt [s].  done[k]: 1 where p[k] has its forces; 0
 * where it has to be looked at, and t[k] has what was told for its pose. */
void fl_told_touch(const fl_world *w, fl_pair *const *p, int n, double dt, int survey, uint8_t *done,
                   fl_told *t);

#endif
