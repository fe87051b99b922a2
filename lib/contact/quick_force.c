/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "base/simd.h"
#include "contact/crushing.h"
#include "contact/pair_damping.h"
#include "contact/pair_friction.h"
#include "contact/pair_stiffness.h"
#include "contact/pair_surrogate.h"
#include "contact/panel_load.h"
#include "contact/quick_force.h"

/* Damping of the law `quick`: a wrench on A about the midpoint of the centres, world axes.
 *
 *     D = chi F (c e + (dE/dt - (e.dE/dt) e)/K),    e = E/F
 *
 *   E, F    elastic wrench, and the size of its force
 *   c       approach speed along the force at the centre of pressure, at the end of the step
 *   dE/dt   rate of the wrench in the step since `before`, as seen by axes that turn with the mean of both
 *   bodies K       dF/ds
 * A speed along the force is damped as in Hunt and Crossley's law; what turns or moves the pressure, as
 * rocking does, is damped by the same coefficient chi F, which a point or area of the contact has.  The
 * second part is held below the moment and force that the pressure can have.
 *   arm   radius of the pressure [m] */
FL_SIMD_INLINE fl_wrench change_damping(const fl_pair *p, const fl_pair_prediction *a, fl_wrench before,
                                        fl_vec3 spin, double chi, double c, double slope, double arm)
{
    const fl_wrench E = fl_wrench_about_middle(p->force, p->torque_i, p->torque_j);
    const double size = v3_norm(E.f), lowest = -1.0 / chi, speed = c > lowest ? c : lowest;
    fl_wrench damping = {v3_scale(chi * speed, E.f), v3_scale(chi * speed, E.m)};
    if (!(a->step.dt > 0.0 && slope > 0.0 && v3_norm2(before.f) > 0.0)) return damping;
    const double dt = a->step.dt;
    fl_wrench rate = {v3_sub(v3_sub(E.f, before.f), v3_scale(dt, v3_cross(spin, before.f))),
                      v3_sub(v3_sub(E.m, before.m), v3_scale(dt, v3_cross(spin, before.m)))};
    rate = fl_wrench_madd(rate, -v3_dot(E.f, rate.f) / (size * size), E);
    /* force over the load, moment over the load and its arm */
    const double by = chi * size / (slope * dt), load = size * (1.0 + chi * speed),
                 much = by * (v3_norm(rate.f) + (arm > 0.0 ? v3_norm(rate.m) / arm : 0.0)),
                 part = much > load ? load / much : 1.0;
    return fl_wrench_madd(damping, by * part, rate);
}

/* The springs, as s^2 over an area, spread farther than the pressure, as s^3: where a face is tilted by 7/5.
 * With that the bound came out 5 % below the highest frequency of a heap (S05 of verify_step).  Neither
 * follows from the terms: of 2000 poses of two boxes the bound is 1.5 to 1.6 times the largest omega^2 found
 * by differences (median), but 0.27 at least, for the weights of edges and crossings change within a small
 * part of R. */
#define QUICK_SPREAD 1.4
#define QUICK_MARGIN 1.2

/* Springs that bound those of the terms. */
static fl_spring_sums bounding_springs(const fl_quick_sums *q, const fl_sym3 *second)
{
    fl_spring_sums at = fl_quick_springs(q, second, QUICK_MARGIN * q->ddu);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) at.angular[r][c] *= QUICK_SPREAD;
    return at;
}

/* The elastic wrench of the step before, about the midpoint.  By a surrogate it has an error, nearly that of
 * the value t for the present pose, which is no rate: it is taken off. */
static fl_wrench wrench_before(const fl_pair *p, const fl_pair_prediction *a, const fl_surrogate_value *t,
                               const fl_relative_pose *r)
{
    if (!t || !p->surrogate->used || !fl_surrogate_in_double_range(p->surrogate, t)) return a->before.elastic;
    const fl_wrench now = fl_wrench_about_middle(p->force, p->torque_i, p->torque_j);
    const fl_vec3 f = m3_mul(r->R, t->gradient.f), at = v3_madd(m3_mul(r->R, t->point), 0.5, r->off);
    const fl_wrench value = {f, v3_add(v3_cross(at, f), m3_mul(r->R, t->gradient.m))};
    return fl_wrench_madd(fl_wrench_madd(a->before.elastic, 1.0, now), -1.0, value);
}

/* Builds the surrogate of a pair of the law `quick`; size, mass: of the elastic force.  -1 when memory runs
 * out. */
static int update_quick_surrogate(fl_world *w, fl_pair *p, int32_t thread, const fl_quick_sums *q,
                                  const fl_surrogate_value *t, const fl_relative_pose *r, fl_vec3 n,
                                  double mass)
{
    fl_quick_exact rest;
    fl_exact_contact exact;
    fl_exact_contact_of_quick(w, p, r, q, &rest, &exact);
    const fl_vec3 aj = m3_mul(r->R, exact.first), ai = v3_add(aj, r->off);
    const double speed = v3_dot(n, fl_pair_relative_velocity(&w->b, p, ai, aj));
    /* the force at the energy of the motion, since W grows as its square */
    exact.motion_force = sqrt(1.0 + 0.5 * mass * speed * speed / exact.energy);
    exact.stiffness_i = p->omega2_i, exact.stiffness_j = p->omega2_j;
    return fl_exact_contact_free_path(w, p, thread, &exact) ||
                   fl_pair_update_surrogate(w, p, thread, t, &exact)
               ? -1
               : 0;
}

FL_SIMD_VERSIONS int fl_pair_evaluate_quick(fl_world *w, fl_pair *p, int32_t thread, const fl_quick_sums *q,
                                            const fl_surrogate_value *t, const fl_relative_pose *r,
                                            const fl_pair_prediction *a, int survey)
{
    const int crushes = fl_pair_crushes(w, p),
              has_surrogate = p->law->surrogate_tolerance > 0.0 && !fl_panels_need_points(w, p) && !crushes;
    const fl_bodies *b = &w->b;
    const fl_mat3 R = r->R;
    const fl_vec3 none = v3(0, 0, 0);
    if (!(q->u > 0.0 && q->overlap > FL_OVERLAP_ROUNDING * (v3_norm(r->o) + b->bounding_radius[p->i])))
        return 0;
    double energy = p->k * sqrt(q->u), scale = 0.5 * energy / q->u,
           slope = fl_patch_slope(scale, q->u, q->pressure, q->ddu, q->overlap), limit = INFINITY,
           stiffer = 1.0;
    const double each = 1.0 / q->pressure;
    int yields = 0;
    const fl_vec3 centre = v3_scale(each, q->moment), aj = m3_mul(R, centre), ai = v3_add(aj, r->off);
    const fl_sym3 second = fl_quick_second_moments(q);
    const double spread = second.xx + second.yy + second.zz, arm = spread > 0.0 ? sqrt(spread) : 0.0;
    if (crushes) {
        fl_exact_contact exact = {.scale = scale, .energy = energy, .slope = slope};
        fl_vec3 aside; /* none between floes */
        yields = fl_crushing_yield(w, p, r, q->gradient.f, centre, &exact, &limit, &aside);
        if (yields < 0) return -1;
        if (exact.slope != slope) stiffer = fmax((exact.slope / slope) * (scale / exact.scale), 1.0);
        energy = exact.energy, scale = exact.scale, slope = exact.slope;
    }
    p->overlap = q->overlap;
    p->energy = energy;
    fl_add_scaled_wrench(&p->force, &p->torque_i, &p->torque_j, &q->gradient, scale, &R, r->off, none);
    const fl_vec3 elastic = p->force, n = v3_unit(elastic);
    const fl_pair_mobility ease = fl_pair_mobility_of(w, p);
    const double pressed = scale * q->pressure, size = v3_norm(elastic),
                 mass = fl_pair_mass(w, p, &ease, elastic, p->torque_i, p->torque_j),
                 compliance = fl_pair_compliance(&ease, elastic, p->torque_i, p->torque_j, pressed),
                 predicted = -v3_dot(n, fl_pair_end_velocity(b, p, a, ai, aj)),
                 damping = fl_pair_damping_factor(p, predicted > 0.0 ? predicted : 0.0, mass),
                 room = limit / size - 1.0,
                 chi = yields                                          ? 0.0
                       : predicted > 0.0 && predicted * damping > room ? fmax(room, 0.0) / predicted
                                                                       : damping;
    fl_contact_compliance at_contact = {.turn = 0.0};
    double damped = 1.0;
    if (chi > 0.0) {
        const double more = fl_predictor_share(size, pressed) *
                            fl_pair_approach_correction(a, predicted, size, chi * size, compliance);
        const fl_vec3 spin = v3_scale(0.5, v3_add(b->w[p->i], b->w[p->j])), off = v3_scale(0.5, r->off);
        const fl_wrench D =
            change_damping(p, a, wrench_before(p, a, t, r), spin, chi, predicted + more, slope, arm);
        p->force_damping = D.f;
        p->torque_i_damping = v3_add(v3_cross(off, D.f), D.m);
        p->torque_j_damping = v3_sub(v3_cross(off, D.f), D.m);
        fl_pair_stabilise_damping(p, pressed, chi, r, a);
        damped = fmax(0.0, 1.0 + chi * (predicted + more));
        if (p->law->friction > 0.0) {
            at_contact.matrix = fl_pair_compliance_matrix(&ease, ai, aj);
            at_contact.turn = fl_pair_turn_compliance(&ease, n);
        }
    }
    p->force = v3_add(p->force, p->force_damping);
    p->torque_i = v3_add(p->torque_i, p->torque_i_damping);
    p->torque_j = v3_add(p->torque_j, p->torque_j_damping);
    const fl_vec3 normal = v3_unit(q->direction);
    fl_patch_result all = {.energy = energy,
                           .force = elastic,
                           .elastic = pressed,
                           .normal = damped * pressed,
                           .direction = v3_scale(damped * scale, m3_mul(R, q->direction)),
                           .centre = aj,
                           .shape = fl_pressure_shape_of(second, normal),
                           .slope = slope};
    all.load = v3_norm(all.direction);
    all.couple = v3_sub(v3_scale(scale, m3_mul(R, q->gradient.m)), v3_cross(aj, elastic));
    all.shape.elongation = m3_mul(R, all.shape.elongation);
    if (t && fl_surrogate_in_double_range(p->surrogate, t) && fabs(slope - t->slope) < 0.5 * t->slope)
        fl_tangent_rescale(&p->springs, slope / t->slope, slope < p->surrogate->slope);
    fl_pair_add_friction(w, p, &all, chi, &at_contact, r, a);
    survey |= has_surrogate && (!t || fl_pair_stiffness_is_due(w));
    if (survey) {
        const fl_spring_sums at = bounding_springs(q, &second);
        fl_stiffness si, sj;
        const fl_vec3 force = p->force, ti = p->torque_i, tj = p->torque_j;
        p->force = elastic;
        p->torque_i = v3_sub(v3_sub(ti, p->torque_i_damping), p->torque_i_friction);
        p->torque_j = v3_sub(v3_sub(tj, p->torque_j_damping), p->torque_j_friction);
        fl_pair_add_patch_stiffness(w, p, &at, R, ai, aj, stiffer * scale, q->u, &si, &sj);
        p->force = force, p->torque_i = ti, p->torque_j = tj;
        fl_pair_bound_stiffness(w, p, &all, r, &si, &sj);
    }
    if (has_surrogate && update_quick_surrogate(w, p, thread, q, t, r, n, mass)) return -1;
    p->energy += p->spring_energy;
    return p->touching = 1;
}
