/* SPDX-License-Identifier: GPL-3.0-or-later */
/* awake.h -- the near pairs that a step has to look at, and which thread takes which.
 *
 * Most near pairs sleep, and those that touch are spread over all.  Each thread has a share of them in a row,
 * bounded where the contacts of the step before are halved, thirded, ...; it takes blocks from the front of
 * it, and from the shares of others when its own is used up.  So contacts are shared out evenly, and from
 * step to step most stay with the thread that has them in its cache.  Who looks at a pair bears on no bit:
 * each writes its own result. */
#ifndef FL_STEP_AWAKE_H
#define FL_STEP_AWAKE_H
#include "step/told.h"
#include "world/world.h"

/* Before the threads begin: the shares; nothing has met. */
void fl_awake_share(fl_world *w);

/* All near pairs that may touch, as fl_near_awake(), w->hit of them and w->met; by every thread of a team.
 * Others may still be at theirs when it returns. */
void fl_awake_look(fl_world *w, double dt, int survey);

/* When w->hit is known of all: w->live; w->failed where there is no room for it. */
void fl_awake_told(fl_world *w);

/* Evaluates the c-th near pair, as fl_interact_look(), unless its bounding volumes are apart. */
void fl_near_awake(fl_world *w, int32_t c, int32_t thread, const fl_told *t, double dt, int survey);

#endif
