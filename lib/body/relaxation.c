/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "body/relaxation.h"
#include <math.h>

static const double CRITICAL_SHARE = 0.7, LARGEST = 0.5, KEPT = 0.98;

fl_relaxation fl_relaxation_start(enum fl_relaxation_kind kind, double c)
{
    return (fl_relaxation){
        .kind = kind, .c = kind == FL_RELAXATION_VISCOUS ? c : 0.0, .fresh = 1, .rests = 1};
}

void fl_relaxation_adapt(fl_relaxation *r, double work, double inertia, double dt)
{
    if (r->kind != FL_RELAXATION_ADAPTIVE || !(inertia > 0.0)) return;
    /* A motion that releases energy has no frequency: it is left undamped. */
    double c = work > 0.0 ? 2.0 * CRITICAL_SHARE * dt * sqrt(work / inertia) : 0.0;
    if (c > LARGEST) c = LARGEST;
    r->c = r->fresh ? c : KEPT * r->c + (1.0 - KEPT) * c;
    r->fresh = 0;
}

int fl_relaxation_peak(fl_relaxation *r, double kinetic)
{
    r->rests = r->kind == FL_RELAXATION_KINETIC && kinetic < r->kinetic;
    r->kinetic = r->rests ? 0.0 : kinetic;
    return r->rests;
}

enum { FIRE_DELAY = 5 };
static const double FIRE_GROWTH = 1.1, FIRE_CUT = 0.5, FIRE_MIX = 0.1, FIRE_MIX_FALL = 0.99,
                    FIRE_LEAST = 0.02;

fl_fire fl_fire_start(double dt_most)
{
    return (fl_fire){
        .dt = 0.3 * dt_most, .dt_most = dt_most, .dt_least = FIRE_LEAST * dt_most, .mix = FIRE_MIX};
}

fl_fire_step fl_fire_next(fl_fire *r, double power, double force2, double speed2)
{
    fl_fire_step s = {.keep = 1.0, .push = 1.0};
    if (power > 0.0) {
        if (++r->downhill > FIRE_DELAY) {
            r->dt = fmin(FIRE_GROWTH * r->dt, r->dt_most);
            r->mix *= FIRE_MIX_FALL;
        }
    } else {
        s.back = speed2 > 0.0 ? 0.5 * r->dt : 0.0;
        s.keep = 0.0;
        if (speed2 > 0.0) r->dt = fmax(FIRE_CUT * r->dt, r->dt_least);
        r->downhill = 0;
        r->mix = FIRE_MIX;
    }
    s.dt = r->dt;
    /* |v + dt f/m|, of the velocity to be mixed */
    const double v2 = s.keep * s.keep * speed2 + 2.0 * s.keep * r->dt * power + r->dt * r->dt * force2;
    if (force2 > 0.0) {
        s.keep *= 1.0 - r->mix;
        s.push = 1.0 - r->mix + r->mix * sqrt(v2 / force2) / r->dt;
    }
    return s;
}
