/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/stiffness_update.h"
#include <math.h>
#include <omp.h>
#include "contact/bond_list.h"
#include "sim/moving_structure.h"
#include "sphere/contact_list.h"

/* Steps between two updates.  A contact lasts many steps of the default size, so every DEFAULT_INTERVAL
 * steps is enough.  Longer steps could miss a contact in between: they update more often, and every step
 * from four times dt_safe on.  Steps that are short against dt_critical update every SHORT_INTERVAL
 * steps: half a period is pi/2 of the critical step, so a tenth of it has fifteen steps, of which every
 * fourth is used. */
enum { DEFAULT_INTERVAL = 16, SHORT_INTERVAL = 4 };

int fl_stiffness_due(const fl_world *w, int64_t step)
{
    /* with few contacts, all of them may start and end between two updates */
    if (w->contact_steps && !isfinite(w->dt_critical)) return 1;
    const double over = w->dt > w->dt_safe ? w->dt / w->dt_safe : 1.0;
    const double seen = isfinite(w->dt_critical) ? 0.1 * SHORT_INTERVAL * w->dt_critical / w->dt : 0.0;
    const int64_t every = (int64_t)fmax(DEFAULT_INTERVAL / (over * over), fmin(seen, SHORT_INTERVAL));
    return every < 2 || step % every == 0;
}

/* (1 + c) K of pair p for its body i. */
static double omega2_share(const fl_world *w, const fl_pair *p, int32_t i)
{
    if (p->j >= w->n) return w->b.invm[p->j] > 0.0 ? 2.0 * p->omega2_i : p->omega2_i;
    const double own = p->i == i ? p->omega2_i : p->omega2_j;
    return own + sqrt(p->omega2_i * p->omega2_j);
}

static int has_contacts(const fl_world *w, int32_t i)
{
    return w->body_touches[i] || w->spheres.bodies || fl_body_has_bonds(w, i);
}

/* 2/omega by contacts alone, and by contacts and bonds [s]. */
typedef struct {
    double contacts, all;
} limits;

static double limit_of(double omega2) { return omega2 > 0.0 ? 2.0 / sqrt(omega2) : INFINITY; }

/* omega^2 by the contacts of body i. */
static double contact_omega2(const fl_world *w, int32_t i)
{
    double sum = w->spheres.bodies ? fl_sphere_omega2(w, i) : 0.0;
    for (int64_t c = w->first_pair_of_body[i]; c < w->first_pair_of_body[i + 1]; c++) {
        const fl_neighbour_pair *q = &w->pair[w->pairs_of_body[c]];
        if (q->touching) sum += omega2_share(w, q->contact, i);
    }
    return sum;
}

/* Lower *least by the limits of all bodies; *body: the body of least->all, if it was lowered. */
static void find_least(const fl_world *w, limits *least, int32_t *body)
{
    limits own = {w->dt_critical_contacts, w->dt_critical};
    int32_t i_own = INT32_MAX;
    /* the limit of discs alone only grows, as they break */
    const int discs_known = w->discs.limits_known && isfinite(w->dt_critical);
#pragma omp for schedule(static) nowait
    for (int32_t i = 0; i < fl_places_end(w); i++) {
        if (!has_contacts(w, i)) continue;
        const double sum = contact_omega2(w, i);
        if (sum == 0.0 && discs_known && !fl_body_has_faces(w, i)) continue;
        const limits it = {limit_of(sum), limit_of(sum + fl_bond_list_omega2(w, i))};
        if (it.contacts < own.contacts) own.contacts = it.contacts;
        if (it.all < own.all) own.all = it.all, i_own = i;
    }
#pragma omp critical(fl_stiffness_update)
    {
        if (own.contacts < least->contacts) least->contacts = own.contacts;
        if (own.all < least->all || (own.all == least->all && i_own < *body))
            least->all = own.all, *body = i_own;
    }
}

void fl_stiffness_update(fl_world *w)
{
    limits least = {w->dt_critical_contacts, w->dt_critical};
    int32_t body = INT32_MAX;
    if (w->team.n == 1) {
        find_least(w, &least, &body);
    } else {
#pragma omp parallel num_threads(w->team.n)
        find_least(w, &least, &body);
    }
    w->discs.limits_known = 1;
    w->dt_critical_contacts = least.contacts;
    if (body < INT32_MAX) {
        w->dt_critical = least.all;
        w->critical_body = body;
    }
    if (fl_structure_moves(w)) fl_moving_structure_limit(w);
    if (w->zones.set.blocks && w->zones.dt_critical < w->dt_critical) {
        w->dt_critical = w->zones.dt_critical;
        w->critical_body = w->zones.set.block[0].body;
    }
}
