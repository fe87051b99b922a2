/* SPDX-License-Identifier: GPL-3.0-or-later */
/* active_pairs.h -- evaluates the near pairs that are due in a step, shared among the threads.
 *
 * Most near pairs are not due, and those that touch are spread over the whole list.  Each thread has a
 * consecutive share of the list.  The bounds split the contacts of the step before into equal numbers.  A
 * thread takes blocks from the front of its share, then from the shares of others.  So the load is
 * balanced, and from step to step most contacts stay with the thread that has them in its cache.  Pairs are
 * independent: each writes only its own record, so no bit depends on the thread. */
#ifndef FL_CONTACT_ACTIVE_PAIRS_H
#define FL_CONTACT_ACTIVE_PAIRS_H
#include "contact/surrogate_batch.h"
#include "world/world.h"

/* Sets the shares and clears w->body_touches, before the threads start. */
void fl_share_active_pairs(fl_world *w);

/* Evaluates all near pairs that may touch, and sets w->pair_touches and w->body_touches.  Every thread of
 * the team calls it; other threads may still be working when it returns. */
void fl_evaluate_active_pairs(fl_world *w, double dt, int survey);

/* Lists the touching pairs, w->touching_pairs, once w->pair_touches is complete; sets w->failed when memory
 * runs out. */
void fl_collect_touching(fl_world *w);

/* Evaluates near pair c, as fl_pair_evaluate_exact(), unless fl_pair_still_apart(), and stores it. */
void fl_evaluate_neighbour_pair(fl_world *w, int32_t c, int32_t thread, const fl_surrogate_value *t,
                                double dt, int survey);

#endif
