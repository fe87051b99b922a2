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
