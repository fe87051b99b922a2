/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "contact/crushing.h"
#include "contact/pair_damping.h"
#include "contact/pair_friction.h"
#include "contact/pair_stiffness.h"
#include "contact/pair_surrogate.h"
#include "contact/panel_load.h"
#include "contact/patch_force.h"
#include "law/normal.h"

/* Adds damping and friction to the elastic force of a patch.  q: sums over the points, to be multiplied by
 * scale, about the point at aj from B's centre; slope: dF/ds. */
static fl_patch_result add_damping_and_friction(fl_world *w, fl_pair *p, const fl_force_sum *q, double scale,
                                                double slope, double chi, const fl_contact_compliance *at,
                                                const fl_relative_pose *r, fl_vec3 aj,
                                                const fl_pair_prediction *a)
{
    const fl_mat3 *R = &r->R;
    fl_add_scaled_wrench(&p->force_damping, &p->torque_i_damping, &p->torque_j_damping, &q->damping, scale, R,
                         v3_add(aj, r->off), aj);
    fl_pair_stabilise_damping(p, scale * q->pressure, chi, r, a);
    p->force = v3_add(p->force, p->force_damping);
    p->torque_i = v3_add(p->torque_i, p->torque_i_damping);
    p->torque_j = v3_add(p->torque_j, p->torque_j_damping);
    const fl_patch_result all = fl_patch_result_of(q, p->energy, scale, slope, R, aj);
    fl_pair_add_friction(w, p, &all, chi, at, r, a);
    return all;
}

/* lambda of a patch.  elastic: the force; spin: relative spin, world axes. */
static double sustained_share_of_patch(const fl_world *w, fl_pair *p, const fl_patch_points *s,
                                       const fl_force_sum *q, const fl_exact_contact *exact, fl_vec3 elastic,
                                       const fl_relative_pose *r, const fl_pair_prediction *a, fl_vec3 spin,
                                       double mass)
{
    const fl_bodies *b = &w->b;
    if (!(q->pressure > 0.0)) return 0.0;
    const double each = 1.0 / q->pressure, mean = each * q->pressure_rate;
    const fl_vec3 n = v3_unit(elastic), aj = m3_mul(r->R, v3_madd(s->point[0].p, each, q->pressure_moment)),
                  core = fl_pair_end_velocity(
                      b, p, a, v3_madd(v3_add(aj, r->off), p->radius_factor * b->radius[p->i], n),
                      v3_madd(aj, -p->radius_factor * b->radius[p->j], n));
    return fl_pair_sustained_share(w, p, exact->scale * q->pressure, exact->slope, mass,
                                   v3_madd(core, -v3_dot(core, n), n), v3_madd(spin, -v3_dot(spin, n), n),
                                   fmax(each * fl_force_sum_square(s) - mean * mean, 0.0));
}

int fl_pair_evaluate_patch(fl_world *w, fl_pair *p, int32_t thread, const fl_surrogate_value *t,
                           const fl_relative_pose *r, const fl_pair_prediction *a, int survey)
{
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    fl_patch_points *s = &w->scratch[thread];
    const int crushes = fl_pair_crushes(w, p),
              has_surrogate = p->law->surrogate_tolerance > 0.0 && !fl_panels_need_points(w, p) && !crushes;
    if (s->n == 0) return 0;
    const fl_vec3 at = s->point[0].p, aj = m3_mul(R, at), ai = v3_add(aj, r->off);
    fl_force_sum q;
    if (fl_force_sum_elastic(s, &q)) return -1;
    if (!(q.u > 0.0 && q.overlap > FL_OVERLAP_ROUNDING * (v3_norm(r->o) + b->bounding_radius[p->i])))
        return 0;
    fl_exact_contact exact;
    fl_exact_contact_find(w, p, s, r, &q, &exact);
    double limit = INFINITY, stiffer = 1.0;
    fl_vec3 aside = v3(0, 0, 0);
    int yields = 0;
    if (crushes) {
        const double scale = exact.scale, slope = exact.slope;
        yields = fl_crushing_yield(w, p, r, q.gradient.f, v3_madd(at, 1.0 / q.pressure, q.pressure_moment),
                                   &exact, &limit, &aside);
        if (yields < 0) return -1;
        stiffer = exact.slope != slope ? fmax((exact.slope / slope) * (scale / exact.scale), 1.0) : 1.0;
        if (p->crush) stiffer *= 1.0 + v3_norm2(p->crush->lean);
    }
    p->overlap = q.overlap;
    p->energy = exact.energy;
    fl_add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q.gradient, exact.scale, &R, ai, aj);
    const fl_vec3 elastic = p->force;
    fl_contact_compliance at_contact;
    double compliance = exact.inv_mass, mass = p->mass;
    if (!fl_pair_is_free(w, p)) {
        const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
        const fl_vec3 middle = m3_mul(R, v3_scale(1.0 / q.pressure, q.pressure_moment));
        mass = fl_pair_mass(w, p, &ease, elastic, p->torque_i, p->torque_j);
        at_contact.matrix = fl_pair_compliance_matrix(&ease, v3_add(ai, middle), v3_add(aj, middle));
        at_contact.turn = fl_pair_turn_compliance(&ease, v3_unit(elastic));
        compliance = fl_pair_compliance(&ease, elastic, p->torque_i, p->torque_j, exact.scale * q.pressure);
    } else {
        at_contact.matrix = s3_rotated(exact.compliance, m3_col(R, 0), m3_col(R, 1), m3_col(R, 2));
        at_contact.turn = exact.turn_compliance;
    }
    const fl_vec3 spin = v3_add(v3_sub(b->w[p->i], b->w[p->j]), v3_sub(a->change.wi, a->change.wj));
    const fl_vec3 v = m3_tmul(R, fl_pair_end_velocity(b, p, a, ai, aj)), turn = m3_tmul(R, spin);
    if (fl_force_sum_motion(s, v, turn, &q)) return -1;
    const double damping = fl_pair_damping_factor(p, q.du > 0.0 ? q.du_approach / q.du : 0.0, mass),
                 coming = q.pressure_rate / q.pressure, room = limit / v3_norm(elastic) - 1.0,
                 chi = yields                                    ? 0.0
                       : coming > 0.0 && coming * damping > room ? fmax(room, 0.0) / coming
                                                                 : damping;
    const double sustained = fl_pair_is_on_facets(w, p)
                                 ? sustained_share_of_patch(w, p, s, &q, &exact, elastic, r, a, spin, mass)
                                 : 0.0;
    const double size = v3_norm(elastic), more = fl_predictor_share(size, exact.scale * q.pressure) *
                                                 fl_pair_approach_correction(a, q.pressure_rate / q.pressure,
                                                                             size, chi * size, compliance);
    const double whole = fl_damping_whole_approach(
        q.pressure_rate / q.pressure, -(v3_dot(q.gradient.f, v) + v3_dot(q.gradient.m, turn)) / q.pressure);
    fl_force_sum_damping(s, chi, more, sustained, whole, &q);
    fl_stiffness si, sj;
    fl_spring_sums point_springs;
    if (survey || has_surrogate) fl_force_sum_springs(s, &point_springs);
    survey |= has_surrogate && (!t || fl_pair_stiffness_is_due(w));
    if (survey)
        fl_pair_add_patch_stiffness(w, p, &point_springs, R, ai, aj, stiffer * exact.scale, q.u, &si, &sj);
    if (t && fl_surrogate_in_double_range(p->surrogate, t) && fabs(exact.slope - t->slope) < 0.5 * t->slope)
        fl_tangent_rescale(&p->springs, exact.slope / t->slope, exact.slope < p->surrogate->slope);
    const fl_patch_result all =
        add_damping_and_friction(w, p, &q, exact.scale, exact.slope, chi, &at_contact, r, aj, a);
    if (v3_norm2(aside) > 0.0) {
        const fl_vec3 middle = m3_mul(R, v3_scale(1.0 / q.pressure, q.pressure_moment));
        fl_add_wrench(&p->force, &p->torque_i, &p->torque_j, m3_mul(R, aside), v3_add(ai, middle),
                      v3_add(aj, middle));
    }
    if (survey) fl_pair_bound_stiffness(w, p, &all, r, &si, &sj);
    if (has_surrogate) {
        const double speed = v3_dot(v3_unit(elastic), fl_pair_relative_velocity(b, p, ai, aj));
        fl_pressure_moments pressing;
        fl_force_sum_pressure(s, &pressing);
        exact.springs = &point_springs, exact.pressing = &pressing;
        exact.v = v, exact.spin = turn, exact.impact_damping = chi, exact.speed_offset = more;
        /* the force at the energy of the motion, since W grows as its square */
        exact.motion_force = sqrt(1.0 + 0.5 * mass * speed * speed / p->energy);
        exact.stiffness_i = p->omega2_i, exact.stiffness_j = p->omega2_j;
        if (fl_exact_contact_free_path(w, p, thread, &exact) ||
            fl_pair_update_surrogate(w, p, thread, t, &exact))
            return -1;
    }
    p->energy += p->spring_energy;
    if (fl_panels_need_points(w, p)) {
        for (int32_t k = 0; k < s->n; k++)
            s->point[k].approach_speed =
                (1.0 - sustained) * fl_force_sum_approach_speed(s, k) + (sustained * whole + more);
        fl_panels_record_points(w, p, s, exact.scale, chi);
    }
    return p->touching = 1;
}
