/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pair_stiffness.h"
#include "contact/rolling_pair.h"

void fl_pair_bound_stiffness(const fl_world *w, fl_pair *p, const fl_patch_result *q,
                             const fl_relative_pose *r, fl_stiffness *si, fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    if (p->springs.k > 0.0) {
        const fl_vec3 n = v3_unit(q->direction), aj = q->centre;
        const fl_vec3 ai = v3_add(aj, r->off), none = v3(0, 0, 0);
        fl_stiffness_add_tangential(si, b, p->i, p->springs.k, n, ai);
        fl_stiffness_add_tangential(sj, b, p->j, p->springs.k, n, aj);
        fl_stiffness_add_force(si, b, p->i, p->springs.k_turn, none, n);
        fl_stiffness_add_force(sj, b, p->j, p->springs.k_turn, none, n);
    }
    for (int axis = 0; axis < 3 && p->rolling; axis++) {
        const fl_vec3 e = v3(axis == 0, axis == 1, axis == 2), none = v3(0, 0, 0);
        fl_stiffness_add_force(si, b, p->i, fl_rolling_turn_stiffness(p->rolling), none, e);
        fl_stiffness_add_force(sj, b, p->j, fl_rolling_turn_stiffness(p->rolling), none, e);
    }
    p->omega2_i = fl_stiffness_bound(si);
    p->omega2_j = fl_stiffness_bound(sj);
}

void fl_pair_bound_point_stiffness(const fl_world *w, fl_pair *p, const fl_patch_result *q, fl_vec3 n,
                                   const fl_relative_pose *r)
{
    fl_stiffness si = {0}, sj = {0};
    fl_stiffness_add_force(&si, &w->b, p->i, q->slope, n, v3_cross(v3_add(q->centre, r->off), n));
    fl_stiffness_add_force(&sj, &w->b, p->j, q->slope, n, v3_cross(q->centre, n));
    fl_pair_bound_stiffness(w, p, q, r, &si, &sj);
}

void fl_pair_add_patch_stiffness(const fl_world *w, const fl_pair *p, const fl_spring_sums *q, fl_mat3 R,
                                 fl_vec3 ai, fl_vec3 aj, double scale, double U, fl_stiffness *si,
                                 fl_stiffness *sj)
{
    const fl_bodies *b = &w->b;
    const double half = 0.5 / (scale * U);
    *si = *sj = (fl_stiffness){0};
    fl_stiffness_add_springs(si, b, p->i, scale, q, R, ai);
    fl_stiffness_add_springs(sj, b, p->j, scale, q, R, aj);
    fl_stiffness_add_force(si, b, p->i, -half, p->force, p->torque_i);
    fl_stiffness_add_force(sj, b, p->j, -half, p->force, p->torque_j);
}
