/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "sim/member_structure.h"
#include <math.h>

int fl_member_structure_make(fl_world *w, const fl_member_model *m, fl_err *err)
{
    const fl_scene *s = w->scene;
    fl_member_motion *v = &w->moving.members;
    const double level = s->water.head.present ? s->water.level : 0.0;
    if (fl_member_motion_make(v, m, level, s->structure.member_damping, err)) return -1;
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k;
        fl_member_motion_pose(v, k, &w->b.x[j], &w->b.q[j]);
        w->b.invm[j] = fl_member_motion_compliance(v, k, 0.0);
        w->b.m[j] = w->b.invm[j] > 0.0 ? 1.0 / w->b.invm[j] : 0.0;
        fl_body_set_inertia(&w->b, j, v3(INFINITY, INFINITY, INFINITY));
    }
    return 0;
}

void fl_member_structure_first_half(fl_world *w)
{
    fl_member_motion *v = &w->moving.members;
    fl_bodies *b = &w->b;
    const double over = 1.0 / w->dt;
    fl_member_dynamics_damp(&v->dynamics);
    fl_member_dynamics_kick(&v->dynamics, 0.5 * w->dt);
    fl_member_dynamics_drift(&v->dynamics);
    for (int32_t k = 0; k < w->pieces; k++) {
        const int32_t j = w->n + k;
        const fl_vec3 x = b->x[j];
        const fl_quat q = b->q[j];
        const fl_velocity_change before = {b->v[j], b->w[j]};
        fl_member_motion_pose(v, k, &b->x[j], &b->q[j]);
        fl_quat d = q_mul(b->q[j], q_conj(q)); /* chord of the rotation, as in integrate.c */
        if (d.w < 0.0) d = (fl_quat){-d.w, -d.x, -d.y, -d.z};
        const fl_vec3 turn = v3(2.0 * d.x, 2.0 * d.y, 2.0 * d.z), moved = v3_sub(b->x[j], x);
        b->v[j] = v3_scale(over, moved);
        b->w[j] = v3_scale(over, turn);
        fl_set_predicted_change(w, j, v3_sub(b->v[j], before.v), v3_sub(b->w[j], before.w));
        b->odometer[j] += v3_norm(moved) + v3_norm(turn) * b->bounding_radius[j];
    }
}

static void load_balls(fl_world *w)
{
    fl_member_motion *v = &w->moving.members;
    fl_member_motion_clear(v);
    for (int32_t k = 0; k < w->pieces; k++)
        fl_member_motion_load(v, k, w->b.x[w->n + k], w->b.f[w->n + k], w->b.t[w->n + k]);
}

void fl_member_structure_second_half(fl_world *w, double h)
{
    fl_member_motion *v = &w->moving.members;
    load_balls(w);
    if (h > 0.0) {
        fl_member_dynamics_kick(&v->dynamics, h);
        fl_member_dynamics_damp(&v->dynamics);
    }
    for (int32_t k = 0; k < w->pieces; k++)
        fl_member_motion_velocity(v, k, w->b.x[w->n + k], &w->b.v[w->n + k], &w->b.w[w->n + k]);
}

/* Largest distance from the point c along e at which body i can touch, on a line from lo to hi. */
static double reach_of(const fl_world *w, int32_t i, fl_vec3 c, fl_vec3 e, double lo, double hi)
{
    const fl_poly *p = &w->b.core[i];
    const fl_vec3 along = m3_tmul(fl_body_axes(&w->b, i), e);
    const double at = v3_dot(e, v3_sub(w->b.x[i], c));
    double least = INFINITY, most = -INFINITY;
    for (int32_t v = 0; v < p->nv; v++) {
        const double s = at + v3_dot(along, p->v[v]);
        least = fmin(least, s);
        most = fmax(most, s);
    }
    least = fmax(lo, least - w->b.radius[i]);
    most = fmin(hi, most + w->b.radius[i]);
    return fmax(fabs(least), fabs(most));
}

/* Distance along cylinder k at which contact p pushes it, from the middle of its piece: that of its elastic
 * force, or, where that is small, the largest at which the two can touch. */
static double arm_of(const fl_world *w, const fl_pair *p, int32_t k)
{
    const fl_vec3 c = fl_member_motion_middle(&w->moving.members, k), end = w->b.x[p->j];
    const fl_vec3 e = q_rotate(w->b.q[p->j], v3(0, 0, 1));
    const fl_vec3 f = v3_sub(p->force, v3_add(p->force_damping, p->force_friction));
    const fl_vec3 t = v3_sub(v3_sub(p->torque_j, v3_add(p->torque_j_damping, p->torque_j_friction)),
                             v3_cross(v3_sub(end, c), f));
    const double from = v3_dot(e, v3_sub(end, c)), size2 = v3_norm2(f),
                 reach = reach_of(w, p->i, c, e, from, from + w->structure.piece[k].h);
    return size2 > 0.0 ? fmin(reach, sqrt(v3_norm2(t) / size2)) : reach;
}

/* Forces that act on one ball through several cylinders add up: the bound of a piece has the contacts of all
 * cylinders at its two balls. */
double fl_member_structure_critical_step(const fl_world *w)
{
    const fl_member_motion *v = &w->moving.members;
    const fl_member_chain *c = &v->dynamics.chain;
    double most = 0.0;
    for (int32_t b = 0; b < c->balls; b++) v->contact_stiffness[b] = 0.0;
    for (int pass = 0; pass < 2; pass++)
        for (int32_t k = 0; k < w->pieces; k++) {
            const int32_t j = w->n + k;
            const fl_member_contact *e = &c->contact[v->cylinder[k].contact];
            double own = 0.0, arm = 0.0;
            if (w->b.invm[j] == 0.0) continue;
            for (int64_t q = w->first_pair_of_body[j]; q < w->first_pair_of_body[j + 1]; q++) {
                const fl_neighbour_pair *p = &w->pair[w->pairs_of_body[q]];
                if (!p->touching) continue;
                own += p->contact->omega2_j / w->b.invm[j];
                arm = fmax(arm, arm_of(w, p->contact, k));
            }
            if (own == 0.0) continue;
            if (pass == 0) {
                v->contact_stiffness[e->i] += own;
                v->contact_stiffness[e->j] += own;
                continue;
            }
            const double all = v->contact_stiffness[e->i] + v->contact_stiffness[e->j] - own;
            most = fmax(most, 2.0 * all * fl_member_motion_compliance(v, k, arm));
        }
    return most > 0.0 ? 2.0 / sqrt(most) : INFINITY;
}

double fl_member_structure_omega2(const fl_world *w, double k)
{
    const fl_member_motion *v = &w->moving.members;
    double most = 0.0;
    for (int32_t p = 0; p < v->cylinders; p++) {
        const double arm = 0.5 * v->dynamics.chain.contact[v->cylinder[p].contact].length;
        most = fmax(most, fl_member_motion_compliance(v, p, arm));
    }
    return 2.0 * k * most;
}

void fl_member_structure_part_motion(const fl_world *w, int32_t part, fl_loads_motion *out)
{
    const fl_member_motion *v = &w->moving.members;
    const int32_t b = v->watched[part];
    if (b < 0) return;
    const fl_member_ball *a = &v->dynamics.chain.ball[b];
    out->u = v3_sub(a->d, v->dynamics.equilibrium[b]);
    out->v = a->v;
    out->a = fl_member_dynamics_acceleration(&v->dynamics, b);
}

void fl_member_structure_refresh(fl_world *w)
{
    fl_member_dynamics_refresh(&w->moving.members.dynamics);
    load_balls(w);
}

int fl_member_structure_check(const fl_world *w, fl_err *err)
{
    const fl_member_motion *v = &w->moving.members;
    const fl_member_dynamics *d = &v->dynamics;
    for (int32_t b = 0; b < d->chain.balls; b++)
        if (!v3_finite(d->chain.ball[b].d) || !v3_finite(d->chain.ball[b].v) ||
            !v3_finite(d->chain.ball[b].w))
            return fl_fail(err, FL_NUMERIC, "%s: not a finite number in step %lld (t = %g s)", v->model->file,
                           (long long)w->step, fl_world_time(w));
    if (d->over_rotated)
        return fl_fail(err, FL_NUMERIC,
                       "%s: a piece of a member was turned by more than 1 rad before t = %g s: the structure "
                       "collapses, or its members need more pieces",
                       v->model->file, fl_world_time(w));
    return 0;
}

/* Displacement of an end of a contact. */
static fl_vec3 end_moved(const fl_member_chain *c, const fl_member_contact *e, int end)
{
    if (!e->arms) return c->ball[end ? e->j : e->i].d;
    return v3_sub(fl_member_contact_end(c, e, end), fl_member_contact_start(c, e, end));
}

fl_member_forces_row fl_member_structure_row(const fl_world *w, int32_t contact)
{
    const fl_member_motion *v = &w->moving.members;
    const fl_member_chain *c = &v->dynamics.chain;
    const fl_member_contact *e = &c->contact[contact];
    int32_t first = contact;
    while (first > 0 && c->contact[first - 1].member == e->member) first--;
    fl_member_forces_row row = {.member = v->model->member_name.name[e->member],
                                .piece = contact - first + 1,
                                .at = (contact - first + 0.5) * e->length,
                                .u = v3_scale(0.5, v3_add(end_moved(c, e, 0), end_moved(c, e, 1)))};
    fl_member_section_forces(c, contact, &row.force, &row.moment);
    return row;
}
