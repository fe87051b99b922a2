/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_water_kernel.h -- drag and buoyancy of one sphere in still water by value.  Loops over lanes
 * (sphere/floating_batch.c) and devices (gpu/step_kernel.h) get the bits of environment.c.  No call but sqrt.
 *
 * Drag (drag.h): the exact decay of u = v - c and of the spin over h,
 *     u <- u m/(m + 1/2 C_f rho A |u| h),     w <- w k/(k + 1/2 C_m rho A r^3 w^2 |w| h),  k = w.L,
 * along the vertical with the added mass m_a in m.  The cap under water with t = level - z + r:
 *     V = fill pi t^2 (3 r - t)/3,     A = fill 2 pi r t,     m_a = c_a rho V. */
#ifndef FL_WATER_SPHERE_WATER_KERNEL_H
#define FL_WATER_SPHERE_WATER_KERNEL_H
#include "base/pi.h"
#include "base/simd.h"
#include "body/sphere_motion_kernel.h"

typedef struct {
    double c_force, c_moment, h; /* 1/2 C rho of the drag [kg/m3]; half a step [s] */
    fl_vec3 flow;                /* [m/s] */
    double turns;                /* 1: there is a drag moment */
} fl_sphere_drag;

/* Kinetic energy, as fl_body_kinetic_energy(); turning: w.L. */
FL_SIMD_INLINE double fl_sphere_kinetic(double m, double up, fl_vec3 v, double turning, int heavy)
{
    return heavy ? 0.5 * ((v.x * (m * v.x) + v.y * (m * v.y) + v.z * (up * v.z)) + turning)
                 : 0.5 * (m * v3_norm2(v) + turning);
}

/* The decay of velocities, as decay_velocity() of environment.c.  area: wetted [m2]; *lost: change of the
 * kinetic energy [J], 0 for a dry sphere, which keeps its motion. */
FL_SIMD_INLINE fl_sphere_motion fl_sphere_decay(fl_sphere_motion a, double m, double up, double area,
                                                double r, fl_sphere_drag d, int heavy, double *lost)
{
    fl_sphere_motion q;
    const double c = d.c_force * area;
    const fl_vec3 u = v3_sub(a.v, d.flow);
    const double turning = v3_dot(a.w, a.L), speed = sqrt(v3_norm2(u)), spin2 = v3_norm2(a.w),
                 decay = m / (m + c * speed * d.h), rise = up / (up + c * speed * d.h),
                 moment = d.c_moment * area * r * r * r * spin2,
                 slow = turning / (turning + moment * sqrt(spin2) * d.h),
                 spin = d.turns > 0.0 && turning > 0.0 ? slow : 1.0;
    const fl_vec3 v = v3(d.flow.x + decay * u.x, d.flow.y + decay * u.y,
                         d.flow.z + (heavy ? rise : decay) * u.z),
                  L = v3_scale(spin, a.L), w = v3_scale(spin, a.w);
    const int wet = area > 0.0;
    const double change =
        fl_sphere_kinetic(m, up, v, v3_dot(w, L), heavy) - fl_sphere_kinetic(m, up, a.v, turning, heavy);
    *lost = wet ? change : 0.0;
    q.v = v3(wet ? v.x : a.v.x, wet ? v.y : a.v.y, wet ? v.z : a.v.z);
    q.L = v3(wet ? L.x : a.L.x, wet ? L.y : a.L.y, wet ? L.z : a.L.z);
    q.w = v3(wet ? w.x : a.w.x, wet ? w.y : a.w.y, wet ? w.z : a.w.z);
    return q;
}

typedef struct {
    double area, buoyancy; /* wetted [m2]; [N] */
} fl_sphere_float;

/* Cap under water, as fl_environment_force().  volume, surface: of the whole sphere; weight: rho g [N/m3]. */
FL_SIMD_INLINE fl_sphere_float fl_sphere_floats(double z, double r, double fill, double volume,
                                                double surface, double level, double weight)
{
    fl_sphere_float q;
    const double above = level - z, t = above + r;
    const double cap = fill * (PI * t * t * (3.0 * r - t) / 3.0), wet = fill * (2.0 * PI * r * t);
    const int under = above >= r || t >= 2.0 * r, dry = !(above > -r) || t <= 0.0;
    q.buoyancy = weight * (under ? volume : dry ? 0.0 : cap);
    q.area = under ? surface : dry ? 0.0 : wet;
    return q;
}

#endif
