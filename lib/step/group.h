/* SPDX-License-Identifier: GPL-3.0-or-later */
/* group.h -- the two halves of a step for bodies by groups, FL_BALLS_GROUP in a row, each in the hands of one
 * thread.  What of a group goes alike goes several at a time (few.h, calm.h, plain.h), with the bits that it
 * gets one by one. */
#ifndef FL_STEP_GROUP_H
#define FL_STEP_GROUP_H
#include "world/access.h"

/* The two longest ways so far, and another. */
static inline void fl_longest(double first[2], double moved)
{
    if (moved > first[0]) first[1] = first[0], first[0] = moved;
    else if (moved > first[1]) first[1] = moved;
}

/* Drag and kick of h and drift of 2 h of those of groups [g, last) that move in this step; gain[] of those
 * that something presses is what the kick changes, and moved of w->group[] how far they have come. */
void fl_groups_begin(fl_world *w, int32_t g, int32_t last, double h);

/* The same of those that are FL_ENDS, each with the step that its sleep was (sleep.h). */
void fl_groups_rouse(fl_world *w, int32_t g, int32_t last);

/* Forces on the bodies of these groups, their kick of h (0 at the start: there is none), what the water
 * takes, and what the books want of them: w->group[]. */
void fl_groups_end(fl_world *w, int32_t g, int32_t last, double h);

#endif
