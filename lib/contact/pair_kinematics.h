/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_kinematics.h -- wrenches of a pair and its predicted velocities at a contact, for all contact laws.
 *
 *     u = v_A - v_B at the contact,     mean of the step: u + lag,     at its end: u + lag + du
 *
 *   u    fl_pair_relative_velocity() [m/s]
 *   lag  fl_pair_rotation_lag() [m/s]
 *   du   fl_predicted_change_at() [m/s]
 * A contact point is at ai from A's centre and at aj from B's, world axes [m]. */
#ifndef FL_CONTACT_PAIR_KINEMATICS_H
#define FL_CONTACT_PAIR_KINEMATICS_H
#include "contact/pair_geometry.h"
#include "contact/velocity_predictor.h"

/* An overlap below this fraction of the coordinates it results from is rounding error. */
#define FL_OVERLAP_ROUNDING 3e-14

/* Adds a force at a contact point to the force on A and the torques of both. */
FL_SIMD_INLINE void fl_add_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, fl_vec3 force, fl_vec3 ai, fl_vec3 aj)
{
    *f = v3_add(*f, force);
    *ti = v3_add(*ti, v3_cross(ai, force));
    *tj = v3_sub(*tj, v3_cross(aj, force));
}

/* Adds a force and its moment about a point, in the frame of B, times scale.  The point is at ai from A's
 * centre and at aj from B's, world axes. */
FL_SIMD_INLINE void fl_add_scaled_wrench(fl_vec3 *f, fl_vec3 *ti, fl_vec3 *tj, const fl_wrench *w,
                                         double scale, const fl_mat3 *R, fl_vec3 ai, fl_vec3 aj)
{
    const fl_vec3 moment = v3_scale(scale, m3_mul(*R, w->m));
    fl_add_wrench(f, ti, tj, v3_scale(scale, m3_mul(*R, w->f)), ai, aj);
    *ti = v3_add(*ti, moment);
    *tj = v3_sub(*tj, moment);
}

FL_SIMD_INLINE fl_vec3 fl_pair_relative_velocity(const fl_bodies *b, const fl_pair *p, fl_vec3 ai, fl_vec3 aj)
{
    return v3_sub(fl_body_point_velocity(b, p->i, ai), fl_body_point_velocity(b, p->j, aj));
}

/* Input of the velocity predictor. */
typedef struct {
    fl_predictor_step step;
    fl_vec3 lag; /* fl_pair_rotation_lag() [m/s] */
    fl_predicted_change_of_pair change;
    fl_previous_force before;
} fl_pair_prediction;

static inline fl_pair_prediction fl_pair_prediction_of(const fl_world *w, const fl_pair *p,
                                                       const fl_relative_pose *r, double dt)
{
    const fl_vec3 lag = fl_pair_rotation_lag(&w->b, p, r->off, dt);
    return (fl_pair_prediction){fl_predictor_step_of(w, dt), lag, fl_predict_change_of_pair(w, p, lag),
                                fl_previous_force_of(p)};
}

/* Correction of the predicted approach speed c; the arguments are those of fl_predict_approach(). */
static inline double fl_pair_approach_correction(const fl_pair_prediction *a, double c, double elastic,
                                                 double C, double compliance)
{
    return fl_predict_approach(c, elastic, C, compliance, a->change.contact_count, a->step, a->before) - c;
}

FL_SIMD_INLINE fl_vec3 fl_pair_mean_velocity(const fl_bodies *b, const fl_pair *p,
                                             const fl_pair_prediction *a, fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(fl_pair_relative_velocity(b, p, ai, aj), a->lag);
}

FL_SIMD_INLINE fl_vec3 fl_pair_end_velocity(const fl_bodies *b, const fl_pair *p, const fl_pair_prediction *a,
                                            fl_vec3 ai, fl_vec3 aj)
{
    return v3_add(fl_pair_mean_velocity(b, p, a, ai, aj), fl_predicted_change_at(&a->change, ai, aj));
}

#endif
