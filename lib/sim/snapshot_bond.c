/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/snapshot_bond.h"
#include <stdlib.h>
#include "base/array.h"
#include "contact/bond_list.h"
#include "contact/disc_setup.h"
#include "contact/joint_list.h"

/* A joint: where its points lie, and their memory. */
static void exchange_joint(fl_state_io *t, fl_bond *c, fl_joint *q)
{
    fl_vec3 *const place[] = {&c->pi, &c->pj, &c->ai, &c->aj, &c->bi, &c->bj};
    fl_state_io_open(t, "joint");
    fl_state_io_real(t, &c->area);
    fl_state_io_real(t, &q->laid_area);
    fl_state_io_real(t, &q->clipped[0]);
    fl_state_io_real(t, &q->clipped[1]);
    fl_state_io_real(t, &q->friction_loss);
    fl_state_io_int(t, 0, FL_BOND_POINTS, &q->slips);
    fl_state_io_int(t, 0, FL_BOND_POINTS, &q->opens);
    for (int e = 0; e < 6; e++) fl_state_io_vec3(t, place[e]);
    for (int e = 0; e < FL_BOND_POINTS; e++) {
        fl_joint_point *p = &q->point[e];
        double *const number[] = {&q->sigma[e], &p->sigma, &p->tau[0], &p->tau[1], &p->offset,
                                  &p->slip,     &p->angle, &p->ratio,  &p->way[0], &p->way[1]};
        for (int k = 0; k < 10; k++) fl_state_io_real(t, number[k]);
        fl_state_io_int(t, 0, 1, &p->failed);
        fl_state_io_int(t, 0, 1, &p->open);
    }
    fl_state_io_close(t);
}

/* A bond: its memory and its forces.  Separations follow from the poses of the bodies, face and law from the
 * scene. */
static void exchange_bond(fl_state_io *t, fl_world *w, int32_t k)
{
    fl_bond *c = &w->bonds.bond[k];
    fl_vec3 *const all[] = {&c->force,          &c->torque_i,          &c->torque_j,
                            &c->force_damping,  &c->torque_i_damping,  &c->torque_j_damping,
                            &c->force_friction, &c->torque_i_friction, &c->torque_j_friction};
    fl_state_io_open(t, "bond");
    fl_state_io_int(t, FL_BOND_INTACT, FL_BOND_ENDED, &c->state);
    fl_state_io_real(t, &c->h0);
    fl_state_io_real(t, &c->wear);
    fl_state_io_real(t, &c->dissipated);
    fl_state_io_real(t, &c->given_to_friction);
    fl_state_io_real(t, &c->elastic_energy);
    fl_state_io_real(t, &c->friction_spring_energy);
    fl_state_io_real(t, &w->bonds.radius_factor[k]);
    for (int e = 0; e < 9; e++) fl_state_io_vec3(t, all[e]);
    for (int e = 0; e < FL_BOND_POINTS; e++) {
        fl_bond_point *p = &c->point[e];
        if (t->in) *p = (fl_bond_point){0};
        if (c->state == FL_BOND_INTACT || t->err->code) continue;
        fl_state_io_real(t, &p->d);
        fl_state_io_real(t, &p->lambda_c);
        fl_state_io_real(t, &p->lambda_f);
        fl_state_io_real(t, &p->slip[0]);
        fl_state_io_real(t, &p->slip[1]);
        if (t->in && !t->err->code &&
            !(p->d >= 0.0 && p->d <= 1.0 && p->lambda_c >= 0.0 && p->lambda_f >= p->lambda_c))
            fl_text_fail(t->in, t->err, "damage %g between %g and %g is not possible in a bond", p->d,
                         p->lambda_c, p->lambda_f);
    }
    fl_state_io_close(t);
}

void fl_snapshot_bonds(fl_state_io *t, fl_world *w)
{
    for (int32_t k = 0; k < w->bonds.n && !t->err->code; k++) exchange_bond(t, w, k);
    for (int32_t k = w->bonds.faces; k < w->bonds.n && !t->err->code; k++)
        if (fl_joint_of_bond(&w->bonds, k))
            exchange_joint(t, &w->bonds.bond[k], &w->bonds.joint[k - w->bonds.faces]);
    if (t->in && !t->err->code) fl_bond_list_refresh(w);
}

/* A bond of spheres: its memory.  The forces of a step follow from it in the next one alone. */
static void exchange_disc(fl_state_io *t, fl_world *w, int32_t k)
{
    fl_disc_list *s = &w->discs;
    fl_disc_memory m = fl_disc_list_memory(s, k);
    fl_disc_wrench *f = &s->at.out[k];
    fl_state_io_open(t, "disc");
    fl_state_io_byte(t, FL_DISC_ENDED, &s->has_ended[k]);
    fl_state_io_vec3(t, &m.S), fl_state_io_vec3(t, &m.M);
    fl_state_io_real(t, &m.lambda);
    fl_state_io_real(t, &m.dissipated), fl_state_io_real(t, &m.friction_loss);
    fl_state_io_real(t, &s->pending[k]);
    fl_state_io_vec3(t, &f->force), fl_state_io_vec3(t, &f->couple_i), fl_state_io_vec3(t, &f->couple_j);
    if (s->at.damped) {
        fl_state_io_vec3(t, &m.damping_force), fl_state_io_vec3(t, &m.damping_couple);
        fl_state_io_real(t, &m.damped);
    }
    fl_state_io_close(t);
    if (!t->in || t->err->code) return;
    if (!(m.lambda >= 0.0)) fl_text_fail(t->in, t->err, "lambda = %g is not possible in a bond", m.lambda);
    else fl_disc_list_set_memory(s, k, &m);
}

/* Which bonds an endless sheet has by now, and what is kept of those that have left. */
static void exchange_renewal(fl_state_io *t, fl_world *w)
{
    fl_disc_list *s = &w->discs;
    int32_t n = s->n;
    fl_disc_past *p = &s->past;
    fl_disc_birth *all = NULL;
    int32_t cap = 0;
    fl_state_io_open(t, "bonds");
    fl_state_io_int(t, 0, 1, &s->is_renewed);
    fl_state_io_int(t, 0, INT32_MAX, &n);
    fl_state_io_int(t, 0, INT32_MAX, &p->broken);
    fl_state_io_int(t, 0, INT32_MAX, &p->left);
    fl_state_io_real(t, &p->area);
    fl_state_io_real(t, &p->dissipated), fl_state_io_real(t, &p->damped);
    fl_state_io_real(t, &p->friction_loss);
    fl_state_io_close(t);
    for (int32_t k = 0; k < n && s->is_renewed && !t->err->code; k++) {
        if (t->in && fl_grow(&all, &cap, (int64_t)k + 1, sizeof *all, t->err)) break;
        fl_disc_birth d = t->f ? fl_disc_list_birth(s, k) : (fl_disc_birth){0};
        fl_state_io_open(t, "link");
        fl_state_io_int(t, 0, w->n - 1, &d.i);
        fl_state_io_int(t, 0, w->n - 1, &d.j);
        fl_state_io_real(t, &d.length);
        for (int e = 0; e < 3 && w->cell.periodic; e++)
            fl_state_io_int(t, -INT32_MAX, INT32_MAX, &d.image[e]);
        fl_state_io_close(t);
        if (!t->in || t->err->code) continue;
        if (d.i >= d.j || !(d.length > 0.0) || (k > 0 && d.i < all[k - 1].i))
            fl_text_fail(t->in, t->err, "a bond of spheres %d and %d is not possible here", d.i, d.j);
        all[k] = d;
    }
    if (t->in && s->is_renewed && !t->err->code) fl_disc_list_restore(w, all, n, t->err);
    free(all);
}

void fl_snapshot_discs(fl_state_io *t, fl_world *w)
{
    fl_disc_list *s = &w->discs;
    if (w->inflow.join.first) exchange_renewal(t, w);
    for (int32_t k = 0; k < s->n && !t->err->code; k++) exchange_disc(t, w, k);
    if (!t->in) return;
    s->ended = 0;
    for (int32_t k = 0; k < s->n; k++) s->ended += s->has_ended[k] == FL_DISC_JUST_ENDED;
}
