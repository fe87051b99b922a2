/* SPDX-License-Identifier: GPL-3.0-or-later */
/* surrogate_batch.h -- forces of contacts that have hardly moved, from their surrogates
 * (patch/surrogate.h), several at a time: one array for each quantity, one contact in each lane.  The bits
 * of a contact do not depend on the other lanes. */
#ifndef FL_CONTACT_SURROGATE_BATCH_H
#define FL_CONTACT_SURROGATE_BATCH_H
#include "contact/panel_load.h"
#include "world/world.h"

/* True if the surrogate may stand in for contact p: it has been evaluated before and no output needs its
 * points. */
static inline int fl_surrogate_applies(const fl_world *w, const fl_pair *p)
{
    return p->touching && p->surrogate && p->surrogate->valid && !fl_panels_need_points(w, p);
}

/* Evaluates n <= FL_SURROGATE_BATCH contacts, for which fl_surrogate_applies(), over a step of dt [s].
 * done[k] is 1 if p[k] has its forces.  It is 0 if p[k] needs an exact evaluation; t[k] is then the value
 * for its pose. */
void fl_surrogate_batch_evaluate(const fl_world *w, fl_pair *const *p, int n, double dt, int survey,
                                 uint8_t *done, fl_surrogate_value *t);

#endif
