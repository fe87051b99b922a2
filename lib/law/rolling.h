/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rolling.h -- what keeps a sphere from rolling on another, and from spinning on it: an elastic spring of how
 * the two have turned against each other, with damping, and a limit.
 *
 *     M = -k_r theta - eta w,   |M| <= mu_r R* F_n,   k_r = 2.25 mu_r^2 R*^2 k_n,      w = w_i - w_j,
 *
 * k_n = dF_n/ds, R* = r_i r_j/(r_i + r_j), or the radius of the sphere on what is no sphere.  So it gives
 * way where the two have turned by 4/9 F_n/(k_n mu_r R*), by Hertz 8/27 s/(mu_r R*); eta has the part of k_r
 * that damping has of k_n.  Across n that resists rolling, about it spinning; both together have
 * the one limit.  M/R* is a force [N], and R* w a velocity [m/s]: so it is a spring of tangent.h, remembered,
 * unloaded, limited and damped as that is, of stiffness 2.25 mu_r^2 k_n and the limit mu_r F_n.
 * Source: model C of Ai, Chen, Rotter & Ooi, Powder Technology 206 (2011) 269; k_r of Jiang, Yu & Harris,
 * Computers and Geotechnics 32 (2005) 340. */
#ifndef FL_LAW_ROLLING_H
#define FL_LAW_ROLLING_H
#include "law/tangent.h"

/* What a contact remembers, and the moment on i of the last step, both over R*. */
typedef struct {
    fl_vec3 elastic; /* of the spring                        [N]   */
    double k;        /* stiffness that it was built with     [N/m] */
    fl_vec3 total;   /* with damping                         [N]   */
    double arm;      /* R*                                   [m]   */
} fl_rolling_spring;

/* The part of k_n that a spring of mu_r has. */
FL_SIMD_INLINE double fl_rolling_stiffness_ratio(double rolling) { return 2.25 * rolling * rolling; }

/* How the two turn: R* w in the mean of the step, and as foreseen for its end; and the mean of both spins,
 * with which what is remembered turns. */
typedef struct {
    fl_vec3 mean, end; /* [m/s]   */
    fl_vec3 spin;      /* [rad/s] */
} fl_rolling_motion;

/* One step of it; c: of the contact, k_n, chi F_e and F_n with mu_r. */
FL_SIMD_INLINE fl_rolling_spring fl_rolling_step(fl_rolling_spring s, fl_tangent_spring c,
                                                 fl_rolling_motion by, double dt, double half, double begins)
{
    const fl_vec3 turned = v3_madd(s.elastic, dt, v3_cross(by.spin, s.elastic)),
                  was = v3_sub(s.total, s.elastic);
    const fl_friction_forces now =
        fl_tangent_point_step(s.elastic, turned, s.k, c, by.mean, by.end, was, dt, half, begins);
    return (fl_rolling_spring){now.elastic.f, c.k, now.total.f, s.arm};
}

/* Energy of the spring [J]. */
FL_SIMD_INLINE double fl_rolling_energy(fl_rolling_spring s)
{
    return s.k > 0.0 ? 0.5 * v3_norm2(s.elastic) / s.k : 0.0;
}

#endif
