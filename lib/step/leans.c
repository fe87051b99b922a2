/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "law/normal.h"
#include "step/leans.h"
#include "step/stiff.h"

static void load(const fl_world *w, fl_spheres *a, int32_t m, const fl_pair *p, fl_vec3 d)
{
    const fl_bodies *b = &w->b;
    const fl_touching *law = p->law;
    const fl_vec3 u = v3_sub(b->v[p->i], b->v[p->j]), spin = b->w[p->i];
    a->d[0][m] = d.x, a->d[1][m] = d.y, a->d[2][m] = d.z;
    a->u[0][m] = u.x, a->u[1][m] = u.y, a->u[2][m] = u.z;
    a->wi[0][m] = spin.x, a->wi[1][m] = spin.y, a->wi[2][m] = spin.z;
    a->wj[0][m] = a->wj[1][m] = a->wj[2][m] = 0.0;
    a->ri[m] = b->radius[p->i];
    a->rj[m] = 0.0;
    a->invm[m] = law->rest * law->rest * b->invm[p->i];
    a->k[m] = p->k;
    a->friction[m] = law->friction;
    a->tangential[m] = law->tangential;
    a->chi[m] = law->chi;
    a->touch[m] = p->touch;
    a->slip[0][m] = p->slip.force.x, a->slip[1][m] = p->slip.force.y, a->slip[2][m] = p->slip.force.z;
    a->stiff[m] = p->slip.k;
}

int fl_leans_add(const fl_world *w, fl_leans *q, int32_t c)
{
    const fl_near *near = &w->pair[c];
    const fl_bodies *b = &w->b;
    const int32_t i = near->i, j = near->j;
    if (j < w->n + w->pieces || !near->n || !b->ball[i] || w->structure.piece[j - w->n].elastic) return 0;
    const fl_vec3 n = m3_col(fl_body_axes(b, j), 2);
    const double z = v3_dot(n, v3_sub(b->x[i], b->x[j]));
    if (!(z > 0.0 && z < b->radius[i]) || near->full->bond) return 0;
    near->full->at = c;
    load(w, &q->at, q->n, near->full, v3_scale(z, n));
    q->pair[q->n++] = near->full;
    return 1;
}

static fl_vec3 vector(const double a[3][FL_SPHERES_MOST], int32_t m) { return v3(a[0][m], a[1][m], a[2][m]); }

static void save(const fl_world *w, const fl_spheres *a, int32_t m, fl_pair *p, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_vec3 n = vector(a->n, m), zero = v3(0, 0, 0);
    const double over = a->overlap[m], arm = a->ri[m] - 0.5 * over;
    const fl_vec3 at = v3_madd(v3_sub(b->x[p->i], b->x[p->j]), -arm, n); /* from the wall's point */
    p->slip = (fl_slip){.force = vector(a->slip, m), .k = a->stiff[m]};
    p->touch = a->touch[m];
    p->overlap = over;
    p->fd = vector(a->damping, m);
    p->fs = vector(a->rub, m);
    p->f = v3_madd(p->fs, a->normal[m], n);
    p->di = zero;
    p->ti = p->si = vector(a->ti, m);
    p->tj = v3_neg(v3_cross(at, p->f));
    p->dj = v3_neg(v3_cross(at, p->fd));
    p->sj = v3_neg(v3_cross(at, p->fs));
    p->spring = fl_tangent_energy(&p->slip);
    p->energy = p->k * fl_normal_phi(over, 1.5) + p->spring;
    p->stiff_i = survey ? fl_stiff_point(b, p->i, a->slope[m], a->stiff[m], arm) : 0.0;
    p->stiff_j = 0.0;
}

void fl_leans_touch(const fl_world *w, fl_leans *q, double dt, int survey)
{
    if (q->n == 0) return;
    fl_spheres_meet(&q->at, q->n, dt);
    for (int32_t m = 0; m < q->n; m++) save(w, &q->at, m, q->pair[m], survey);
    q->n = 0;
}
