/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "body/integrate.h"
#include "contact/rolling_pair.h"
#include "contact/velocity_predictor.h"

/* 1/I of sphere k, 0 if it cannot rotate, and the predicted change of its angular velocity. */
static double inverse_inertia_of(const fl_world *w, int32_t k, fl_vec3 *dw)
{
    const fl_sphere_state *state = &w->spheres.state[k];
    const double each = 1.0 / state->r;
    *dw = v3_scale(each, state->rdw);
    return each * each * state->inv_inertia;
}

static void load_spring(const fl_world *w, fl_sphere_rolling_batch *q, int32_t m,
                        const fl_rolling_contact *contact)
{
    const fl_rolling_spring *r = contact->roll;
    const double ri = w->b.radius[contact->i];
    fl_vec3 dw, dwj;
    double inv_inertia = inverse_inertia_of(w, contact->i, &dw), arm = ri;
    if (contact->j >= 0) {
        const double rj = w->b.radius[contact->j];
        inv_inertia += inverse_inertia_of(w, contact->j, &dwj);
        dw = v3_sub(dw, dwj);
        arm = ri * rj / (ri + rj);
    }
    q->arm[m] = arm;
    q->rolling[m] = contact->law->rolling;
    q->dw[0][m] = dw.x, q->dw[1][m] = dw.y, q->dw[2][m] = dw.z;
    q->inv_mass[m] = arm * arm * inv_inertia;
    q->elastic[0][m] = r->elastic.x, q->elastic[1][m] = r->elastic.y, q->elastic[2][m] = r->elastic.z;
    q->spring_stiffness[m] = r->k;
    q->total[0][m] = r->total.x, q->total[1][m] = r->total.y, q->total[2][m] = r->total.z;
}

static void save_spring(fl_rolling_spring *r, const fl_sphere_rolling_batch *q, int32_t m)
{
    *r = (fl_rolling_spring){v3(q->elastic[0][m], q->elastic[1][m], q->elastic[2][m]), q->spring_stiffness[m],
                             v3(q->total[0][m], q->total[1][m], q->total[2][m]), q->arm[m]};
}

void fl_rolling_evaluate(const fl_world *w, fl_sphere_batch *batch, const fl_rolling_contact *contact,
                         int32_t m, double dt)
{
    fl_sphere_rolling_batch q; /* large: not cleared */
    for (int32_t k = 0; k < m; k++) load_spring(w, &q, k, &contact[k]);
    if (dt < 0.0) {
        fl_sphere_batch_add_rolling(batch, &q, m);
        return;
    }
    fl_sphere_batch_rolling(batch, &q, m, dt, fl_predictor_step_of(w, dt).half_step);
    for (int32_t k = 0; k < m; k++) save_spring(contact[k].roll, &q, k);
}
