/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rolling.h -- rolling and spinning resistance of a sphere: an elastic moment in the relative rotation,
 * damped and limited.
 *
 *     M = -k_r theta - eta w,   |M| <= mu_r R* F_n,   k_r = 2.25 mu_r^2 R*^2 k_n,      w = w_i - w_j
 *
 *   theta  relative rotation since the contact began [rad]
 *   w      relative angular velocity [rad/s]
 *   k_n    normal stiffness dF_n/ds [N/m]
 *   R*     r_i r_j/(r_i + r_j), or the radius of the sphere where the other body is no sphere [m]
 *   mu_r   coefficient of rolling friction
 *   eta    damping: the fraction of k_r that normal damping is of k_n
 *
 * The limit is reached at the rotation 4/9 F_n/(k_n mu_r R*), which is 8/27 s/(mu_r R*) for Hertz.  The
 * component across the normal n resists rolling, the one along n spinning; both share the limit.
 *
 * M/R* is a force [N] and R* w a velocity [m/s].  The moment is therefore the spring of tangent.h with the
 * stiffness 2.25 mu_r^2 k_n and the limit mu_r F_n.
 * Source: model C of Ai, Chen, Rotter & Ooi, Powder Technology 206 (2011) 269; k_r of Jiang, Yu & Harris,
 * Computers and Geotechnics 32 (2005) 340. */
#ifndef FL_LAW_ROLLING_H
#define FL_LAW_ROLLING_H
#include "law/tangent.h"

/* State of the resistance of one contact: moments on i over R*, world axes. */
typedef struct {
    fl_vec3 elastic; /* moment of the spring over R*               [N]   */
    double k;        /* stiffness at the last step                 [N/m] */
    fl_vec3 total;   /* moment of the last step, with damping      [N]   */
    double arm;      /* R*                                         [m]   */
} fl_rolling_spring;

/* Stiffness of the spring over k_n. */
FL_SIMD_INLINE double fl_rolling_stiffness_ratio(double rolling) { return 2.25 * rolling * rolling; }

/* Relative rotation over a step: R* w in the mean of the step and predicted for its end, and the mean of both
 * angular velocities, with which the remembered moment turns. */
typedef struct {
    fl_vec3 mean, end; /* [m/s]   */
    fl_vec3 spin;      /* [rad/s] */
} fl_rolling_motion;

/* Advances the spring by a step.  c: k_r/R*^2, damping, limit mu_r F_n and inverse mass; half, at_start: as
 * in fl_damping_end_speed(). */
FL_SIMD_INLINE fl_rolling_spring fl_rolling_step(fl_rolling_spring s, fl_tangent_spring c,
                                                 fl_rolling_motion by, double dt, double half,
                                                 double at_start)
{
    const fl_vec3 turned = v3_madd(s.elastic, dt, v3_cross(by.spin, s.elastic)),
                  previous_damping = v3_sub(s.total, s.elastic);
    const fl_friction_forces now = fl_tangent_point_step(s.elastic, turned, s.k, c, by.mean, by.end,
                                                         previous_damping, dt, half, at_start);
    return (fl_rolling_spring){now.elastic.f, c.k, now.total.f, s.arm};
}

/* Energy of the spring [J]. */
FL_SIMD_INLINE double fl_rolling_energy(fl_rolling_spring s)
{
    return s.k > 0.0 ? 0.5 * v3_norm2(s.elastic) / s.k : 0.0;
}

#endif
