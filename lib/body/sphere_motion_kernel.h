/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_motion_kernel.h -- kick and drift of one free sphere by value: integrate.h for an isotropic body.
 * Loops over lanes (sphere/floating_batch.c), fl_drift() and devices (gpu/step_kernel.h) get the same bits as
 * fl_kick() and fl_kick_drift_isotropic().  No call but sqrt.
 *
 *     v += h f/m  (along the vertical with added mass: h f/(m + m_a)),   L += h t,   w = L/I
 *     x += dt v,   q <- rotation by dt L/I about L times q,   way += |dt| |v| */
#ifndef FL_BODY_SPHERE_MOTION_KERNEL_H
#define FL_BODY_SPHERE_MOTION_KERNEL_H
#include "base/simd.h"
#include "geom/quat.h"

typedef struct {
    fl_vec3 v, L, w; /* [m/s], [kg m2/s], [rad/s] */
} fl_sphere_motion;

/* Change of v by a kick of h [s] with the force f [N].  up: mass along the vertical [kg]; heavy: 1 where
 * there is added mass. */
FL_SIMD_INLINE fl_vec3 fl_sphere_velocity_change(fl_vec3 f, double h, double invm, double up, int heavy)
{
    return v3(heavy ? h * (invm * f.x) : h * invm * f.x, heavy ? h * (invm * f.y) : h * invm * f.y,
              heavy ? h * (f.z / up) : h * invm * f.z);
}

/* Kick; turn: 1/I. */
FL_SIMD_INLINE fl_sphere_motion fl_sphere_kick(fl_sphere_motion a, fl_vec3 f, fl_vec3 t, double h,
                                               double invm, double turn, double up, int heavy)
{
    fl_sphere_motion q;
    const fl_vec3 by = fl_sphere_velocity_change(f, h, invm, up, heavy);
    q.v = v3(a.v.x + by.x, a.v.y + by.y, a.v.z + by.z);
    q.L = v3(a.L.x + h * t.x, a.L.y + h * t.y, a.L.z + h * t.z);
    q.w = v3(turn * q.L.x, turn * q.L.y, turn * q.L.z);
    return q;
}

/* Only rounding moves |q| from 1: one Newton step for 1/sqrt(|q|^2) removes it. */
static inline fl_quat fl_quat_renormalised(fl_quat q)
{
    const double s = 1.5 - 0.5 * (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (fl_quat){s * q.w, s * q.x, s * q.y, s * q.z};
}

/* q_of_vector() by value. */
static inline fl_quat fl_quat_turn(fl_vec3 r)
{
    double c, s;
    q_cos_sinc(0.25 * v3_norm2(r), &c, &s);
    s *= 0.5;
    return (fl_quat){c, s * r.x, s * r.y, s * r.z};
}

/* Attitude of a sphere after it has turned for dt with L; 1/I = turn. */
static inline fl_quat fl_sphere_turned(fl_quat q, fl_vec3 L, double turn, double dt)
{
    if (L.x == 0.0 && L.y == 0.0 && L.z == 0.0) return q;
    return fl_quat_renormalised(q_mul(fl_quat_turn(v3_scale(dt * turn, L)), q));
}

#endif
