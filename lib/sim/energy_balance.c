/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/par.h"
#include "body/integrate.h"
#include "sim/energy_balance.h"
#include "step/balls.h"
#include "step/frozen.h"
#include "step/ride.h"
#include "step/works.h"
#include "world/access.h"

/* A residual of no more than this of what is stored may be rounding: that of sums over thousands of floes and
 * steps, each 1e-16 of them. */
#define ROUNDING 1e-12

double fl_step_stored(const fl_world *w)
{
    const fl_ledger *g = &w->ledger;
    return fabs(g->kinetic) + fabs(g->gravity) + fabs(g->elastic) + fabs(g->hydrostatic) + fabs(g->moving) +
           fabs(g->spring) + fabs(g->bond);
}

double fl_step_off(const fl_world *w)
{
    const double off = fabs(w->ledger.residual), share = off / w->ledger.throughput;
    return !(share <= FL_STEP_USABLE) && off <= ROUNDING * fl_step_stored(w) ? 0.0 : share;
}

int fl_step_unbalanced(const fl_world *w)
{
    const fl_ledger *g = &w->ledger;
    const double scale = g->throughput + fabs(g->elastic);
    return fl_step_off(w) > FL_STEP_USABLE && fabs(g->residual) > FL_STEP_USABLE * scale;
}

/* Overlaps past half the radii are deeper than any law is meant for, but as long as the books balance the run
 * may go on: bodies that were put into one another come apart so.  It ends when the residual says that
 * energy is being made. */
int fl_step_balance(fl_world *w, fl_err *err)
{
    const fl_ledger *g = &w->ledger;
    fl_step_ledger(w);
    const double scale = g->throughput + fabs(g->elastic);
    if (!isfinite(g->residual))
        return fl_fail(err, FL_NUMERIC, "the energy is not a finite number in step %lld (t = %g s)",
                       (long long)w->step, fl_world_time(w));
    if (!w->half_steps || !(g->residual > FL_STEP_USABLE * scale)) return 0;
    return fl_fail(
        err, FL_NUMERIC,
        "body %d and %d: they overlapped by more than half of their radii at t = %g s, and energy is "
        "being made, %.3g J of %.3g J, in step %lld (t = %g s); set a smaller run.dt or stiffer contacts",
        w->half_i, w->half_j, w->half_time, g->residual, scale, (long long)w->step, fl_world_time(w));
}

void fl_step_ledger(fl_world *w)
{
    const fl_bodies *b = &w->b;
    fl_ledger *g = &w->ledger;
    double kinetic = 0.0, gravity = 0.0, elastic = 0.0, spring = 0.0, hydro = 0.0, drag = 0.0, wind = 0.0,
           held = 0.0, waves = 0.0;
    const fl_works lies_ahead = fl_works_ahead(w);
    for (int32_t i = 0; i < w->n; i++) {
        const int there = !fl_world_away(w, i);
        if (there) kinetic += fl_body_kinetic(b, i);
        if (there) gravity -= b->m[i] * v3_dot(w->gravity, b->x[i]);
        held += b->held[i];
        if (w->row.n && there) {
            double drawn = 0.0;
            const double k = fl_world_spring(w, i, &drawn);
            elastic += 0.5 * k * drawn * drawn;
        }
        if (b->added) drag -= b->carried[i];
        if (w->sea.n) {
            if (w->sea.water && !w->sea.waves && there) hydro += fl_sea_energy(&w->sea, b, i);
            drag += w->sea.drained[i];
            if (w->sea.blown) wind += w->sea.blown[i];
            if (w->sea.waves) waves += w->sea.waved[i];
        }
    }
    for (int32_t c = 0; c < w->n_live; c++) {
        const fl_pair *p = w->pair[w->live[c]].full;
        elastic += p->energy;
        spring += p->spring;
    }
    if (w->balls.bodies) fl_balls_energy(w, &elastic, &spring);
    const fl_frozen_books frozen = fl_frozen_ledger(w);
    g->bond = frozen.store;
    g->fracture = frozen.spent;
    spring += frozen.spring - frozen.handed;
    g->kinetic = kinetic;
    g->gravity = gravity;
    g->elastic = elastic;
    g->hydrostatic = hydro;
    g->damping_now = g->damping - lies_ahead.damping;
    g->friction_now =
        g->friction - lies_ahead.friction - spring; /* what the springs hold can still come back */
    g->drag = drag;
    g->wind = wind;
    g->waves = waves;
    if (w->ride.m.n) {
        const fl_ride_books r = fl_ride_ledger(w);
        g->moving = r.kinetic;
        g->spring = r.stored;
        g->damper = r.damped;
        held += r.given;
    }
    const double drive = g->drive - lies_ahead.drive + held;
    g->drive_now = drive;
    g->residual = kinetic + gravity + elastic + hydro + g->moving + g->spring + g->bond + g->fracture -
                  g->start + g->damping_now + g->friction_now + drag + g->damper - wind - waves - drive -
                  g->carried;
    const double through = fabs(g->damping_now) + fabs(g->friction_now) + fabs(drag) + fabs(wind) +
                           fabs(waves) + fabs(drive) + kinetic + g->damper + g->moving + fabs(g->fracture);
    if (through > g->throughput) g->throughput = through;
}

uint64_t fl_step_hash(const fl_world *w)
{
    const fl_bodies *b = &w->b;
    uint64_t h = FL_HASH_START;
    for (int32_t i = 0; i < w->n; i++) {
        if (fl_world_away(w, i)) continue;
        h = fl_hash(h, &b->x[i], sizeof b->x[i]);
        h = fl_hash(h, &b->q[i], sizeof b->q[i]);
        h = fl_hash(h, &b->v[i], sizeof b->v[i]);
        h = fl_hash(h, &b->L[i], sizeof b->L[i]);
    }
    for (int32_t k = 0; k < w->ride.m.n; k++) {
        const fl_bodies *m = &w->ride.m.b;
        if (!w->ride.m.motion[k].free) continue;
        h = fl_hash(h, &m->x[k], sizeof m->x[k]);
        h = fl_hash(h, &m->q[k], sizeof m->q[k]);
        h = fl_hash(h, &m->v[k], sizeof m->v[k]);
        h = fl_hash(h, &m->L[k], sizeof m->L[k]);
    }
    return h;
}
