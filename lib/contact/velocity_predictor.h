/* SPDX-License-Identifier: GPL-3.0-or-later */
/* velocity_predictor.h -- predicts the relative velocity of a contact at the end of the current step.
 *
 * Forces are evaluated at the end of a step, but velocities are known in its middle (kick, drift, kick).
 * The second half changes a velocity as the first did, by forces and drag, but for the change of the forces
 * during the step.  That change is corrected separately, fl_predict_approach().  With both the velocity at
 * the end is predicted to order 2.
 *
 *     v_end = v + dv - lag
 *
 *   v    relative velocity in the middle of the step [m/s]
 *   dv   its change in the first half, fl_predicted_change() [m/s]
 *   lag  fl_pair_rotation_lag() [m/s]
 *
 * Only bodies that had contacts at the start of the step have such a change; for others dv = 0, since a
 * contact that begins has had no effect yet. */
#ifndef FL_CONTACT_VELOCITY_PREDICTOR_H
#define FL_CONTACT_VELOCITY_PREDICTOR_H
#include "contact/pair_law.h"
#include "contact/pair_response.h"
#include "contact/pair_store.h"
#include "law/damping.h"
#include "world/access.h"

/* Predicted changes of the velocities of a pair from the middle of the step to its end. */
typedef struct {
    fl_vec3 v;            /* dv - lag of A's centre against B's [m/s] */
    fl_vec3 wi, wj;       /* changes of the angular velocities of A and B [rad/s] */
    fl_vec3 vi, vj;       /* dv of each */
    double contact_count; /* contacts that damp the two bodies, fl_effective_contact_count() */
} fl_predicted_change_of_pair;

/* A force on A and its moment about the midpoint of the two centres, from the torques ti and tj about the
 * centres.  The wrench on B is the opposite one, so the result does not depend on which body is A. */
FL_SIMD_INLINE fl_wrench fl_wrench_about_middle(fl_vec3 f, fl_vec3 ti, fl_vec3 tj)
{
    return (fl_wrench){f, v3_scale(0.5, v3_sub(ti, tj))};
}

/* Forces of the contact in the step before, about the midpoint, world axes; 0 if it did not touch. */
typedef struct {
    fl_wrench elastic, damping;     /* normal forces */
    fl_vec3 friction_damping;       /* friction without its spring [N] */
    double friction_damping_moment; /* and its moment about the normal [N m] */
} fl_previous_force;

/* From the total, damping and friction of fl_pair, about the midpoint. */
FL_SIMD_INLINE fl_previous_force fl_previous_force_from(fl_wrench total, fl_wrench damping,
                                                        fl_wrench friction, fl_friction_springs springs)
{
    return (fl_previous_force){.elastic =
                                   fl_wrench_madd(fl_wrench_madd(total, -1.0, damping), -1.0, friction),
                               .damping = damping,
                               .friction_damping = springs.damping,
                               .friction_damping_moment = springs.damping_moment};
}

static inline fl_previous_force fl_previous_force_of(const fl_pair *p)
{
    return fl_previous_force_from(
        fl_wrench_about_middle(p->force, p->torque_i, p->torque_j),
        fl_wrench_about_middle(p->force_damping, p->torque_i_damping, p->torque_j_damping),
        fl_wrench_about_middle(p->force_friction, p->torque_i_friction, p->torque_j_friction), p->springs);
}

/* The time step.  At the start of a run dt = 0, while bodies may already touch and move. */
typedef struct {
    double dt;        /* step just made [s] */
    double half_step; /* half of it; at the start, half of the first step [s] */
    double at_start;  /* as in fl_damping_end_speed() */
} fl_predictor_step;

static inline fl_predictor_step fl_predictor_step_of(const fl_world *w, double dt)
{
    return dt > 0.0 ? (fl_predictor_step){dt, 0.5 * dt, 0.0} : (fl_predictor_step){dt, 0.5 * w->dt, 1.0};
}

/* Approach speed at the end of the step, fl_damping_end_speed() [m/s].  Magnitudes are compared, not
 * vectors: the direction turns with the contact.
 *   c           predicted approach speed [m/s]
 *   elastic     size of the elastic force now [N]
 *   C           damping coefficient [N s/m]
 *   compliance  fl_pair_compliance() [1/kg]
 *   count       contacts that damp the bodies */
FL_SIMD_INLINE double fl_predict_approach(double c, double elastic, double C, double compliance, double count,
                                          fl_predictor_step by, fl_previous_force before)
{
    const double size = v3_norm(before.elastic.f),
                 damped = size > 0.0 ? v3_dot(before.elastic.f, before.damping.f) / size : 0.0;
    const double known = 1.0 - by.at_start;
    return fl_damping_end_speed(c, C, by.half_step * compliance, count, known * (elastic - size),
                                known * damped, by.at_start);
}

/* Weight of the correction by fl_predict_approach().  Where pressures oppose each other (a slot) the net
 * force F says little, so the correction is reduced: weight 1 while F >= sum/2, else (2F/sum)^2. */
FL_SIMD_INLINE double fl_predictor_share(double elastic, double pressure)
{
    const double part = 4.0 * elastic * elastic, sum = pressure * pressure;
    return part < sum ? part / sum : 1.0;
}

/* Damping with its part across the force held back, so that it does not oscillate.
 *
 * fl_damping_end_speed() covers only the component along the force.  The rest of the damping acts on the
 * predicted motion and is held back like that of many contacts, with the inverse mass 2/M.
 *   elastic, damping  wrenches now
 *   pressure          sum of the pressures [N]
 *   y                 C dt/M of the pressures, twice the y of fl_damping_implicit_weight()
 *   count, at_start   as in fl_damping_end_speed() */
FL_SIMD_INLINE fl_wrench fl_stabilised_damping(fl_wrench elastic, fl_wrench damping, double pressure,
                                               double y, double count, fl_previous_force before,
                                               double at_start)
{
    const fl_wrench change = fl_wrench_madd(before.damping, -1.0, damping);
    const double f2 = v3_norm2(elastic.f), least = 0.25 * pressure * pressure,
                 size2 = f2 > least ? f2 : least,
                 along = size2 > 0.0 ? v3_dot(elastic.f, change.f) / size2 : 0.0;
    const double weight = (fl_damping_implicit_weight(y, count, 2.0 * count) - at_start) * y,
                 part = weight / (1.0 + weight);
    return fl_wrench_madd(damping, part, fl_wrench_madd(change, -along, elastic));
}

/* Number of contacts of body or piece k in the step before: n pair contacts and its sphere contacts
 * (world/sphere_contacts.h), which count once each. */
static inline int32_t fl_previous_contact_count(const fl_world *w, int32_t k, int32_t n)
{
    return w->spheres.bodies && k < w->n ? n + w->spheres.previous_contact_count[k] : n;
}

/* Inverse mass of body or piece k [1/kg], fl_body_inverse_mass().  A part of the structure that only
 * rotates has no mass; y, the inverse mass of the other body, is used for it. */
static inline double fl_predictor_inverse_mass(const fl_world *w, int32_t k, double y)
{
    if (k < w->n) return fl_body_inverse_mass(&w->b, k);
    if (!fl_piece_is_free(w, k)) return 0.0;
    if (fl_structure_has_members(w)) return w->b.invm[k];
    const double mass = w->moving.movers.motion[w->moving.mover_of_piece[k - w->n]].mass;
    return mass > 0.0 ? 1.0 / mass : y;
}

/* Prediction for pair p; lag: fl_pair_rotation_lag() of the step [m/s]. */
static inline fl_predicted_change_of_pair fl_predict_change_of_pair(const fl_world *w, const fl_pair *p,
                                                                    fl_vec3 lag)
{
    const int32_t ni = fl_sums_before(w, p->i)->contacts, nj = fl_sums_before(w, p->j)->contacts;
    const int32_t mi = fl_previous_contact_count(w, p->i, ni), mj = fl_previous_contact_count(w, p->j, nj);
    const double yi = fl_predictor_inverse_mass(w, p->i, 0.0), yj = fl_predictor_inverse_mass(w, p->j, yi),
                 n = fl_effective_contact_count(mi > 1 ? (mi - 1) * yi : 0.0, mj > 1 ? (mj - 1) * yj : 0.0,
                                                yi + yj);
    const fl_velocity_change none = {{0, 0, 0}, {0, 0, 0}};
    const fl_velocity_change i = ni ? *fl_predicted_change(w, p->i) : none,
                             j = nj ? *fl_predicted_change(w, p->j) : none;
    return (fl_predicted_change_of_pair){v3_sub(v3_sub(i.v, j.v), lag), i.w, j.w, i.v, j.v, n};
}

/* Predicted change of A's velocity against B at the arms ai and aj [m/s]. */
static inline fl_vec3 fl_predicted_change_at(const fl_predicted_change_of_pair *l, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(l->v, v3_sub(v3_cross(l->wi, ai), v3_cross(l->wj, aj)));
}

#endif
