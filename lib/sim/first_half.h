/* SPDX-License-Identifier: GPL-3.0-or-later */
/* first_half.h -- the first half of a step for blocks of FL_BODY_BLOCK consecutive floes: drag, kick, drift.
 *
 * One thread works on a block.  Bodies that need the same operations run several at a time (body_batch.h,
 * still_water_batch.h, floating_batch.h), with the same bits as one by one (body_step.h). */
#ifndef FL_SIM_FIRST_HALF_H
#define FL_SIM_FIRST_HALF_H
#include "world/access.h"

/* First half of a step of 2 h for blocks [g, last): drag h, kick h, drift 2 h of all floes that are awake.
 * Stores their velocity changes where contacts or works need them, and the largest paths of w->blocks[]. */
void fl_blocks_first_half(fl_world *w, int32_t g, int32_t last, double h);

/* The same for the floes that are FL_WAKING, each with the length of its own skip (sleep.h). */
void fl_blocks_wake(fl_world *w, int32_t g, int32_t last);

/* The same for n single floes, ascending, where a device moves the others. */
void fl_bodies_first_half(fl_world *w, const int32_t *body, int32_t n, double h);

#endif
