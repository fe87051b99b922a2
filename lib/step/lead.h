/* SPDX-License-Identifier: GPL-3.0-or-later */
/* lead.h -- how a contact will move at the end of the step it is in.
 *
 * Forces are found where the step ends, but speeds are known of its middle.  What the first half of it has
 * changed, by forces and by drag, the second will change as well, but for what forces change by from step to
 * step: so far the speeds of the end are ahead of those of the middle, to order 2.  Only who was pressed at
 * the begin of the step is asked for: fl_world.lead; of others a contact that begins feels nothing yet. */
#ifndef FL_STEP_LEAD_H
#define FL_STEP_LEAD_H
#include "step/pairing.h"
#include "step/works.h"

typedef struct {
    fl_vec3 v;      /* of A's centre against B's, more than fl_pair_lag() has of it [m/s]; */
    fl_vec3 wi, wj; /* of the spins of both                                       [rad/s] */
    double pressed; /* so many contacts the one of them that moves has that has more of them, 1 at least */
} fl_lead;

/* lag: fl_pair_lag() of the step [m/s]. */
static inline fl_lead fl_lead_of(const fl_world *w, const fl_pair *p, fl_vec3 lag)
{
    const fl_gain *const i = fl_works_lead(w, p->i), *const j = fl_works_lead(w, p->j);
    const int32_t ni = fl_works_was(w, p->i)->n, nj = p->j < w->n ? fl_works_was(w, p->j)->n : 0,
                  n = ni > nj ? ni : nj;
    return (fl_lead){v3_sub(v3_sub(i->v, j->v), lag), i->w, j->w, n > 1 ? n : 1};
}

/* Of A's velocity against B at the arms ai and aj. */
static inline fl_vec3 fl_lead_at(const fl_lead *l, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(l->v, v3_sub(v3_cross(l->wi, ai), v3_cross(l->wj, aj)));
}

#endif
