/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surrogate_batch.h -- the forces of contacts that have hardly moved, as their surrogates tell them, several at a time:
 * one array a number, each contact in a lane of its own, whose bits do not hang on what is beside it. */
#ifndef FL_CONTACT_SURROGATE_BATCH_H
#define FL_CONTACT_SURROGATE_BATCH_H
#include "contact/panel_load.h"
#include "world/world.h"

/* Whether contact p may be told of: it has been looked at, and nobody wants to know its places. */
static inline int fl_surrogate_applies(const fl_world *w, const fl_pair *p)
{
    return p->touching && p->surrogate && p->surrogate->valid && !fl_panels_need_points(w, p);
}

/* n <= FL_SURROGATE_BATCH contacts that may be told of, over a step of dt [s].  done[k]: 1 where p[k] has its forces; 0
 * where it has to be looked at, and t[k] has what was told for its pose. */
void fl_surrogate_batch_evaluate(const fl_world *w, fl_pair *const *p, int n, double dt, int survey,
                                 uint8_t *done, fl_surrogate_value *t);

#endif
