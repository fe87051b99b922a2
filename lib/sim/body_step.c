/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "body/integrate.h"
#include "sim/body_step.h"
#include "sphere/contact_force.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/leans.h"
#include "world/access.h"

/* What the spring of a driven floe pulls it down with [N]. */
static double spring_force(const fl_world *w, int32_t i)
{
    double drawn = 0.0;
    const double k = fl_world_spring(w, i, &drawn);
    return k * drawn;
}

/* In waves the work of the water is booked with the kick that it gives. */
void fl_step_kick(fl_world *w, int32_t k, double h)
{
    const fl_vec3 v = w->b.v[k], spin = w->b.w[k];
    fl_kick(&w->b, k, h);
    if (w->sea.waves) fl_sea_book(&w->sea, &w->b, k, h, v, spin);
}

void fl_step_out(fl_world *w, int32_t k, double s)
{
    if (w->sea.n) fl_sea_drag(&w->sea, &w->b, k, 0.5 * s, 0);
    fl_step_kick(w, k, 0.5 * s);
    fl_drift(&w->b, k, s);
}

void fl_step_soft(fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    b->f[k] = v3_scale(b->m[k], w->gravity);
    b->t[k] = v3(0, 0, 0);
    if (w->sea.water) fl_sea_force(&w->sea, b, k);
    if (w->row.n) b->f[k].z -= spring_force(w, k);
}

int fl_step_press(fl_world *w, int32_t k)
{
    fl_bodies *b = &w->b;
    fl_sink *sink = fl_works_now(w, k);
    if (sink->n) *sink = (fl_sink){0};
    if (w->balls.bodies && k < w->n) fl_balls_force(w, k, &b->f[k], &b->t[k]);
    if (w->balls.leans && k >= w->n + w->pieces) fl_leans_press(w, k, &b->f[k], &b->t[k]);
    for (int64_t c = w->inc_first[k]; c < w->inc_first[k + 1]; c++) {
        if (!w->hit[w->inc[c]]) continue;
        const fl_pair *p = w->pair[w->inc[c]].full;
        b->f[k] = v3_madd(b->f[k], p->i == k ? 1.0 : -1.0, p->f);
        b->t[k] = v3_add(b->t[k], p->i == k ? p->ti : p->tj);
        fl_works_add(sink, p, p->i == k);
    }
    if (fl_frozen_at(w, k)) fl_frozen_press(w, k, &b->f[k], &b->t[k], sink);
    return sink->n != 0;
}

void fl_step_gather(fl_world *w, int32_t k)
{
    w->b.f[k] = w->b.t[k] = v3(0, 0, 0);
    if (k < w->n && fl_world_away(w, k)) {
        fl_works_clear(w, k);
        return;
    }
    if (k < w->n) fl_step_soft(w, k);
    fl_step_press(w, k);
}
