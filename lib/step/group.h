/* SPDX-License-Identifier: GPL-3.0-or-later */
/* group.h -- the two halves of a step for bodies by groups, FL_BALLS_GROUP in a row, each in the hands of one
 * thread.  What of a group goes alike goes several at a time (few.h, calm.h, plain.h), with the bits that it
 * gets one by one. */
#ifndef FL_STEP_GROUP_H
#define FL_STEP_GROUP_H
#include "step/world.h"

/* How many there are. */
static inline int32_t fl_groups(const fl_world *w) { return (w->n + FL_BALLS_GROUP - 1) / FL_BALLS_GROUP; }

/* The two longest ways so far, and another. */
static inline void fl_longest(double first[2], double moved)
{
    if (moved > first[0]) first[1] = first[0], first[0] = moved;
    else if (moved > first[1]) first[1] = moved;
}

/* Drag and kick of h and drift of dt of those of group g that move in this step; gain[] of those that
 * something presses is what the kick changes, and moved of w->group[g] how far they have come. */
void fl_group_begin(fl_world *w, int32_t g, double h, double dt);

/* Forces on the bodies of group g, their kick of h (0 at the start: there is none), what the water takes, and
 * what the books want of them: w->group[g]. */
void fl_group_end(fl_world *w, int32_t g, double h);

#endif
