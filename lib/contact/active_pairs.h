/* SPDX-License-Identifier: GPL-3.0-or-later */
/* active_pairs.h -- the near pairs that a step has to look at, and which thread takes which.
 *
 * Most near pairs sleep, and those that touch are spread over all.  Each thread has a share of them in a row,
 * bounded where the contacts of the step before are halved, thirded, ...; it takes blocks from the front of
 * it, and from the shares of others when its own is used up.  So contacts are shared out evenly, and from
 * step to step most stay with the thread that has them in its cache.  Who looks at a pair bears on no bit:
 * each writes its own result. */
#ifndef FL_CONTACT_ACTIVE_PAIRS_H
#define FL_CONTACT_ACTIVE_PAIRS_H
#include "contact/surrogate_batch.h"
#include "world/world.h"

/* Before the threads begin: the shares; nothing has met. */
void fl_share_active_pairs(fl_world *w);

/* All near pairs that may touch, as fl_evaluate_neighbour_pair(), w->hit of them and w->met; by every thread of a team.
 * Others may still be at theirs when it returns. */
void fl_evaluate_active_pairs(fl_world *w, double dt, int survey);

/* When w->hit is known of all: w->live; w->failed where there is no room for it. */
void fl_collect_touching(fl_world *w);

/* Evaluates the c-th near pair, as fl_pair_evaluate_exact(), unless its bounding volumes are apart. */
void fl_evaluate_neighbour_pair(fl_world *w, int32_t c, int32_t thread, const fl_surrogate_value *t,
                                double dt, int survey);

#endif
