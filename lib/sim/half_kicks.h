/* SPDX-License-Identifier: GPL-3.0-or-later */
/* half_kicks.h -- the two halves of a step for bodies by groups, FL_BODY_BLOCK in a row, each in the hands of one
 * thread.  What of a group goes alike goes several at a time (body_batch.h, still_water_batch.h, free_batch.h), with the bits that it
 * gets one by one. */
#ifndef FL_SIM_HALF_KICKS_H
#define FL_SIM_HALF_KICKS_H
#include "world/access.h"

/* Drag and kick of h and drift of 2 h of those of groups [g, last) that move in this step; gain[] of those
 * that something presses is what the kick changes, and moved of w->group[] how far they have come. */
void fl_blocks_first_half(fl_world *w, int32_t g, int32_t last, double h);

/* The same of those that are FL_WAKING, each with the step that its sleep was (sleep.h). */
void fl_blocks_wake(fl_world *w, int32_t g, int32_t last);

/* Forces on the bodies of these groups, their kick of h (0 at the start: there is none), what the water
 * takes, and what the books want of them: w->group[]. */
void fl_blocks_second_half(fl_world *w, int32_t g, int32_t last, double h);

#endif
