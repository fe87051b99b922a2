/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/simd.h"
#include "base/array.h"
#include "contact/pair_friction.h"
#include "contact/rolling_pair.h"
#include "law/material.h"

/* Adds a contact point at `arm` from the first one. */
void fl_point_sum_add(fl_point_sum *s, double elastic, double normal, fl_vec3 n, fl_vec3 arm)
{
    fl_patch_result *const q = &s->result;
    q->elastic += elastic;
    q->normal += normal;
    q->direction = v3_madd(q->direction, normal, n);
    const fl_vec3 a = v3_scale(normal, arm);
    s->moment = v3_add(s->moment, a);
    s->second = s3_add(
        s->second, (fl_sym3){a.x * arm.x, a.x * arm.y, a.x * arm.z, a.y * arm.y, a.y * arm.z, a.z * arm.z});
}

/* The result of n points. */
fl_patch_result fl_point_sum_result(const fl_point_sum *s, int32_t n)
{
    fl_patch_result q = s->result;
    q.load = n > 1 ? q.normal : v3_norm(q.direction);
    if (!(q.normal > 0.0)) return q;
    q.centre = v3_add(q.centre, v3_scale(1.0 / q.normal, s->moment));
    if (n > 1) q.shape = fl_pressure_shape_about(q.normal, s->moment, s->second, v3_unit(q.direction));
    return q;
}

/* Adds friction at the centre of pressure. */
FL_SIMD_VERSIONS void fl_pair_add_friction(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi,
                                           const fl_contact_compliance *at, const fl_relative_pose *r,
                                           const fl_pair_prediction *a)
{
    const fl_bodies *b = &w->b;
    const fl_pair_law *law = p->law;
    if (w->breaking.on) p->load_point = v3_add(q->centre, r->off);
    if (!(law->friction > 0.0 && law->tangential_ratio > 0.0 && q->normal > 0.0)) {
        p->springs = (fl_friction_springs){0};
        return;
    }
    const fl_vec3 aj = q->centre, ai = v3_add(aj, r->off);
    const fl_friction_contact c = {.n = v3_unit(q->direction),
                                   .k = law->tangential_ratio * q->slope,
                                   .g = law->tangential_ratio * chi * q->elastic,
                                   .limit = law->friction * q->load,
                                   .arm = q->shape.arm,
                                   .elongation = q->shape.elongation,
                                   .compliance = at->matrix,
                                   .turn_compliance = at->turn,
                                   .contact_count = a->change.contact_count};
    const double wi = v3_dot(b->w[p->i], c.n), wj = v3_dot(b->w[p->j], c.n),
                 turned = v3_dot(a->change.wi, c.n) - v3_dot(a->change.wj, c.n);
    const fl_vec3 v = fl_pair_mean_velocity(b, p, a, ai, aj);
    const fl_friction_motion by = {v,
                                   v3_add(v, fl_predicted_change_at(&a->change, ai, aj)),
                                   wi - wj,
                                   wi - wj + turned,
                                   0.5 * (wi + wj),
                                   a->before.friction_damping,
                                   a->before.friction_damping_moment,
                                   a->step.half_step,
                                   a->step.at_start};
    const fl_friction_result t = fl_tangent_step_of(p->springs, c, by, a->step.dt, 1);
    const fl_vec3 m = v3_scale(t.moment, c.n);
    p->springs = t.springs;
    fl_add_wrench(&p->force_friction, &p->torque_i_friction, &p->torque_j_friction, t.force, ai, aj);
    p->torque_i_friction = v3_add(p->torque_i_friction, m);
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->force = v3_add(p->force, p->force_friction);
    p->torque_i = v3_add(p->torque_i, p->torque_i_friction);
    p->torque_j = v3_add(p->torque_j, p->torque_j_friction);
    p->spring_energy = p->springs.energy;
}

/* Largest 1/I of body k, 0 if it cannot rotate [1/kg m2]. */
static double max_inverse_inertia(const fl_world *w, int32_t k)
{
    const int held = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ;
    if (k >= w->n || (w->b.fixed_dof[k] & held) == held) return 0.0;
    return fmax(w->b.invI[k].x, fmax(w->b.invI[k].y, w->b.invI[k].z));
}

/* Adds the rolling resistance of a sphere, a moment on both, if its law has one.  -1 when memory runs out. */
int fl_pair_add_rolling(fl_world *w, fl_pair *p, const fl_patch_result *q, double chi,
                        const fl_pair_prediction *a)
{
    const fl_bodies *b = &w->b;
    fl_err lost = {0};
    if (!w->has_rolling || !fl_pair_has_rolling(w, p)) return 0;
    const double arm = fl_material_radius(fl_rolling_radius(w, p->i), fl_rolling_radius(w, p->j)),
                 mu = p->law->rolling, part = fl_rolling_stiffness_ratio(mu);
    if (!p->rolling && !(p->rolling = fl_alloc(1, sizeof *p->rolling, &lost))) return -1;
    const fl_vec3 wi = b->w[p->i], wj = b->w[p->j], turns = v3_scale(arm, v3_sub(wi, wj));
    const fl_tangent_spring c = {.k = part * q->slope,
                                 .g = part * chi * q->elastic,
                                 .limit = mu * fmax(q->normal, 0.0),
                                 .inv_mass = arm * arm *
                                             (max_inverse_inertia(w, p->i) + max_inverse_inertia(w, p->j)),
                                 .contact_count = a->change.contact_count};
    const fl_rolling_motion by = {turns, v3_madd(turns, arm, v3_sub(a->change.wi, a->change.wj)),
                                  v3_scale(0.5, v3_add(wi, wj))};
    p->rolling->arm = arm;
    *p->rolling = fl_rolling_step(*p->rolling, c, by, a->step.dt, a->step.half_step, a->step.at_start);
    const fl_vec3 m = fl_rolling_moment(p->rolling);
    p->torque_i_friction = v3_add(p->torque_i_friction, m),
    p->torque_j_friction = v3_sub(p->torque_j_friction, m);
    p->torque_i = v3_add(p->torque_i, m), p->torque_j = v3_sub(p->torque_j, m);
    p->spring_energy += fl_rolling_energy(*p->rolling);
    return 0;
}
