/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/drive_track.h"

int fl_drive_track_read(fl_world *w, fl_err *err)
{
    const fl_scene_boundary *s = &w->scene->boundary;
    fl_track *tr = &w->driven_floes.track;
    if (fl_track_read(tr, s->drive_track, 1, err)) return -1;
    for (int32_t k = 0; k < tr->n; k++) {
        const double x[] = {tr->value[k].x.x, tr->value[k].x.y, tr->value[k].x.z};
        if (v3_nonzero(tr->value[k].r))
            return fl_fail(err, FL_INPUT, "%s: it rotates at %g s, and driven floes do not rotate",
                           s->drive_track, tr->t[k]);
        for (int c = 0; c < 3; c++)
            if (x[c] != 0.0 && !(s->drive_fixed >> c & 1u))
                return fl_fail(err, FL_INPUT,
                               "%s: it moves along %c at %g s, and %c is not among boundary.drive_fixed",
                               s->drive_track, 'x' + c, tr->t[k], 'x' + c);
    }
    return 0;
}

fl_vec3 fl_drive_track_velocity(const fl_world *w, double t)
{
    fl_pose6 x, rate, second;
    fl_track_evaluate(&w->driven_floes.track, t, &x, &rate, &second);
    return rate.x;
}

static void set_component_of(double m, double *v, double now, double *work)
{
    *work += m * (now - *v) * 0.5 * (now + *v);
    *v = now;
}

void fl_drive_track_begin_step(fl_world *w, double t)
{
    const unsigned fixed = w->scene->boundary.drive_fixed;
    fl_bodies *b = &w->b;
    fl_pose6 from, to, rate, second;
    fl_track_evaluate(&w->driven_floes.track, t, &from, &rate, &second);
    fl_track_evaluate(&w->driven_floes.track, t + w->dt, &to, &rate, &second);
    const fl_vec3 v = v3_scale(1.0 / w->dt, v3_sub(to.x, from.x));
    for (int32_t i = 0; i < w->driven_floes.n; i++) {
        if (!w->driven_floes.is_driven[i] || fl_body_absent(w, i) ||
            (w->inflow.absent && w->inflow.source_floe[i] >= 0))
            continue;
        if (fixed & FL_DOF_X) set_component_of(b->m[i], &b->v[i].x, v.x, &b->work_of_constraints[i]);
        if (fixed & FL_DOF_Y) set_component_of(b->m[i], &b->v[i].y, v.y, &b->work_of_constraints[i]);
        if (fixed & FL_DOF_Z) set_component_of(b->m[i], &b->v[i].z, v.z, &b->work_of_constraints[i]);
    }
}
