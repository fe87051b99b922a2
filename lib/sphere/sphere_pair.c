/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/pair_law.h"
#include "contact/pair_store.h"
#include "contact/rolling_pair.h"
#include "law/normal.h"
#include "sphere/sphere_pair.h"

enum fl_sphere_kind fl_sphere_pair_kind(const fl_world *w, int32_t i, int32_t j)
{
    if (!w->b.is_isotropic[i]) return FL_SPHERE_NONE;
    const int wall = j >= w->n + w->pieces && !w->structure.piece[j - w->n].elastic;
    if (!wall && (j >= w->n || !w->b.is_isotropic[j])) return FL_SPHERE_NONE;
    if (!fl_pair_law_of(w, i, j)->law->spheres) return FL_SPHERE_NONE;
    return wall ? FL_SPHERE_WALL : FL_SPHERE_SPHERE;
}

void fl_sphere_contact_to_pair(const fl_world *w, int32_t i, int32_t j, const fl_sphere_contact *r,
                               const fl_rolling_spring *roll, int touches, fl_vec3 n, double over, fl_pair *p)
{
    const fl_bodies *b = &w->b;
    const double arm = b->radius[i] - 0.5 * over;
    fl_pair_init(w, p, i, j);
    p->free_travel = b->odometer[i] + b->odometer[j] + (over < 0.0 ? -over : 0.0);
    p->touching = touches;
    if (!touches) return;
    p->springs.force = r->spring_force;
    p->springs.k = r->spring_stiffness;
    p->max_approach_speed = r->max_approach_speed;
    p->overlap = over;
    p->force_damping = v3_scale(r->normal_damping, n);
    p->force_friction = r->friction_force;
    p->force = v3_madd(r->friction_force, r->k * fl_normal_power(over, fl_round_exponent(w)) + r->normal_damping, n);
    p->torque_i_friction = p->torque_i =
        v3_madd(fl_rolling_moment(roll), -arm, v3_cross(n, r->friction_force));
    p->spring_energy = fl_sphere_spring_energy(r, roll);
    p->energy = r->k * fl_normal_phi(over, fl_round_exponent(w)) + p->spring_energy;
    p->omega2_i = fl_stiffness_of_point(b, i, r->k * fl_normal_slope(over, fl_round_exponent(w)), r->spring_stiffness, arm,
                                        roll ? fl_rolling_turn_stiffness(roll) : 0.0);
}
