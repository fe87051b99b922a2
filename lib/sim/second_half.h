/* SPDX-License-Identifier: GPL-3.0-or-later */
/* second_half.h -- the second half of a step for blocks of FL_BODY_BLOCK consecutive floes: forces, kick,
 * drag and works.
 *
 * One thread works on a block.  Bodies that need the same operations run several at a time (body_batch.h,
 * still_water_batch.h, free_batch.h, floating_batch.h), with the same bits as one by one (body_step.h). */
#ifndef FL_SIM_SECOND_HALF_H
#define FL_SIM_SECOND_HALF_H
#include "world/access.h"

/* Second half for blocks [g, last): external and contact forces, kick h, drag h, works into w->blocks[].
 * h = 0 computes the forces only, at the start of a run. */
void fl_blocks_second_half(fl_world *w, int32_t g, int32_t last, double h);

/* The same for a single floe whose sums are there, where a device moves the others; returns its works. */
fl_body_block fl_body_second_half(fl_world *w, int32_t k, double h);

#endif
