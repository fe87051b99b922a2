/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "step/rolls.h"
#include "body/integrate.h"
#include "step/lead.h"

/* 1/I of sphere k, where anything lets it turn, and by how much its spin is foreseen to change. */
static double eased(const fl_world *w, int32_t k, fl_vec3 *dw)
{
    const fl_ball_seen *seen = &w->balls.seen[k];
    const double each = 1.0 / seen->r;
    *dw = v3_scale(each, seen->rdw);
    return each * each * seen->turns;
}

static void load(const fl_world *w, fl_spheres_rolls *q, int32_t m, const fl_rolls_row *row)
{
    const fl_roll *r = row->roll;
    const double ri = w->b.radius[row->i];
    fl_vec3 dw, dwj;
    double eases = eased(w, row->i, &dw), arm = ri;
    if (row->j >= 0) {
        const double rj = w->b.radius[row->j];
        eases += eased(w, row->j, &dwj);
        dw = v3_sub(dw, dwj);
        arm = ri * rj / (ri + rj);
    }
    q->arm[m] = arm;
    q->rolling[m] = row->law->rolling;
    q->dw[0][m] = dw.x, q->dw[1][m] = dw.y, q->dw[2][m] = dw.z;
    q->yields[m] = arm * arm * eases;
    q->kept[0][m] = r->kept.x, q->kept[1][m] = r->kept.y, q->kept[2][m] = r->kept.z;
    q->stiff[m] = r->k;
    q->all[0][m] = r->all.x, q->all[1][m] = r->all.y, q->all[2][m] = r->all.z;
}

static void save(fl_roll *r, const fl_spheres_rolls *q, int32_t m)
{
    *r = (fl_roll){v3(q->kept[0][m], q->kept[1][m], q->kept[2][m]), q->stiff[m],
                   v3(q->all[0][m], q->all[1][m], q->all[2][m]), q->arm[m]};
}

void fl_rolls_meet(const fl_world *w, fl_spheres *at, const fl_rolls_row *row, int32_t m, double dt)
{
    fl_spheres_rolls q; /* large: not cleared */
    for (int32_t k = 0; k < m; k++) load(w, &q, k, &row[k]);
    if (dt < 0.0) {
        fl_spheres_roll_on(at, &q, m);
        return;
    }
    fl_spheres_roll(at, &q, m, dt, fl_lead_span(w, dt).half);
    for (int32_t k = 0; k < m; k++) save(row[k].roll, &q, k);
}
