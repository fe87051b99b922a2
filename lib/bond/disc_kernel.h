/* SPDX-License-Identifier: GPL-3.0-or-later */
/* disc_kernel.h -- the arithmetic of disc.h by value: one bond, loops over lanes, and devices get the same
 * bits.  No call but sqrt and fabs. */
#ifndef FL_BOND_DISC_KERNEL_H
#define FL_BOND_DISC_KERNEL_H
#include <math.h>
#include "base/simd.h"
#include "geom/vec3.h"

/* Motion of the two sides over a step, and the elastic state after it. */
typedef struct {
    fl_vec3 e;          /* from i to j */
    double r, N;        /* |d| [m]; k_n (r - l) [N] */
    double opening;     /* rate of r [m/s] */
    fl_vec3 slip, bend; /* rates across e [m/s], of the rotation across e [rad/s] */
    double twist;       /* rate about e [rad/s] */
    fl_vec3 S0, M0;     /* memory, turned to now */
    fl_vec3 S, M;       /* and grown */
} fl_disc_motion;

/* a turned by the small rotation t, to order 2. */
FL_SIMD_INLINE fl_vec3 fl_disc_turned(fl_vec3 a, fl_vec3 t)
{
    const fl_vec3 b = v3_cross(t, a);
    return v3_add(a, v3_madd(b, 0.5, v3_cross(t, b)));
}

FL_SIMD_INLINE fl_disc_motion fl_disc_motion_of(fl_vec3 d, fl_vec3 vi, fl_vec3 vj, fl_vec3 wi, fl_vec3 wj,
                                                fl_vec3 S, fl_vec3 M, double length, double kn, double ratio,
                                                double radius, double share, double dt)
{
    fl_disc_motion q;
    const double ks = ratio * kn, r2 = radius * radius, kb = 0.25 * r2 * kn, kt = 0.5 * r2 * ks;
    const fl_vec3 middle = v3_madd(v3_scale(share, wi), 1.0 - share, wj),
                  t = v3_scale(0.5 * dt, v3_add(wi, wj)), w = v3_sub(wj, wi);
    q.r = sqrt(v3_norm2(d));
    q.e = v3_scale(1.0 / q.r, d);
    q.N = kn * (q.r - length);
    const fl_vec3 v = v3_sub(vj, vi), half = v3_madd(d, -0.5 * dt, v); /* d in the middle of the step */
    const fl_vec3 u = v3_sub(v, v3_cross(middle, half));
    q.opening = v3_dot(u, q.e);
    q.slip = v3_madd(u, -q.opening, q.e);
    q.twist = v3_dot(w, q.e);
    q.bend = v3_madd(w, -q.twist, q.e);
    const fl_vec3 s = fl_disc_turned(S, t);
    q.S0 = v3_madd(s, -v3_dot(s, q.e), q.e);
    q.M0 = fl_disc_turned(M, t);
    q.S = v3_madd(q.S0, dt * ks, q.slip);
    q.M = v3_add(q.M0, v3_madd(v3_scale(dt * kb, q.bend), dt * kt * q.twist, q.e));
    return q;
}

/* Upper bound of lambda^2 times the square of the scatter, without the help of pressing and with sums of
 * components for lengths.  lever: beta/R; pull, cut: 1/(A sigma_t) and 1/(A c), 0 for unlimited. */
FL_SIMD_INLINE double fl_disc_strength_bound(fl_disc_motion q, double lever, double pull, double cut)
{
    const double moment = lever * (fabs(q.M.x) + fabs(q.M.y) + fabs(q.M.z)), N = q.N > 0.0 ? q.N : 0.0,
                 sigma = (N + 4.0 * moment) * pull,
                 tau = (fabs(q.S.x) + fabs(q.S.y) + fabs(q.S.z) + 2.0 * moment) * cut;
    return sigma * sigma + tau * tau;
}

/* Dashpots: force on i, and couple. */
FL_SIMD_INLINE fl_vec3 fl_disc_damping_force(fl_disc_motion q, double kn, double ratio, double damping)
{
    return v3_madd(v3_scale(damping * kn * q.opening, q.e), damping * ratio * kn, q.slip);
}

FL_SIMD_INLINE fl_vec3 fl_disc_damping_couple(fl_disc_motion q, double kn, double ratio, double radius,
                                              double damping)
{
    const double b = 0.25 * radius * radius * damping * kn;
    return v3_madd(v3_scale(b, q.bend), 2.0 * ratio * b * q.twist, q.e);
}

/* Power of a force on i and a couple against the motion [W]. */
FL_SIMD_INLINE double fl_disc_power(fl_disc_motion q, fl_vec3 force, fl_vec3 couple)
{
    return v3_dot(force, v3_madd(q.slip, q.opening, q.e)) + v3_dot(couple, v3_madd(q.bend, q.twist, q.e));
}

#endif
