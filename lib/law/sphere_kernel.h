/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sphere_kernel.h -- the arithmetic of sphere_batch.h by value: one contact of two spheres.  Loops over lanes
 * (sphere_batch.c) and devices (gpu/step_kernel.h) get the same bits.  No call but sqrt.
 *
 * The order of calls: fl_sphere_geometry_of(), fl_sphere_normal_of(), fl_sphere_friction_of(),
 * fl_sphere_forces_of(), and fl_sphere_rolling_of() where there is rolling resistance.  The symbols are those
 * of sphere_batch.h. */
#ifndef FL_LAW_SPHERE_KERNEL_H
#define FL_LAW_SPHERE_KERNEL_H
#include "base/simd.h"
#include "law/damping.h"
#include "law/rolling.h"
#include "law/tangent.h"

/* Number of contacts in one line that damp a motion like n contacts around a sphere, of which two are in
 * line: 3.4 for six, 5.5 for twelve, or less (see critical_step.c). */
FL_SIMD_INLINE double fl_sphere_contacts_in_line(int32_t n) { return n > 2 ? 2.0 + 0.35 * (n - 2) : n; }

/* Distance and elastic force. */
typedef struct {
    fl_vec3 n;      /* (0, 0, 1) where the centres coincide */
    double overlap; /* s [m] */
    double elastic; /* F_e [N] */
    double slope;   /* dF_e/ds [N/m] */
} fl_sphere_geometry;

/* D [m], radii [m], k; linear: 1 for F_e = k s, 0 for k s^(3/2). */
FL_SIMD_INLINE fl_sphere_geometry fl_sphere_geometry_of(double x, double y, double z, double ri, double rj,
                                                        double k, int linear)
{
    fl_sphere_geometry g;
    const double d = sqrt(x * x + y * y + z * z), inverse = d > 0.0 ? 1.0 / d : 0.0;
    const double s = ri + rj - d, root = linear ? (s > 0.0 ? 1.0 : 0.0) : sqrt(s > 0.0 ? s : 0.0);
    g.n = v3(inverse * x, inverse * y, d > 0.0 ? inverse * z : 1.0);
    g.overlap = s;
    g.elastic = k * (s * root);
    g.slope = k * ((linear ? 1.0 : 1.5) * root);
    return g;
}

/* A step, as fl_damping_end_speed() wants it. */
typedef struct {
    double dt, half, at_start; /* [s], [s], 0 or 1 */
} fl_sphere_step;

/* Damping along the normal. */
typedef struct {
    double max_approach_speed; /* v_touch [m/s] */
    double damping_factor;     /* chi [s/m] */
    double normal_damping;     /* F_n - F_e [N] */
} fl_sphere_normal;

/* u, du: velocity of i against j and its predicted change; last, before: v_touch and F_n - F_e of the step
 * before; all other numbers as in fl_sphere_batch. */
FL_SIMD_INLINE fl_sphere_normal fl_sphere_normal_of(fl_vec3 n, double s, double elastic, double k, fl_vec3 u,
                                                    fl_vec3 du, double last, double before,
                                                    double slow_inv_mass, double impact_damping,
                                                    double inv_mass, double contact_count, fl_sphere_step by,
                                                    int linear)
{
    fl_sphere_normal q;
    const double part = linear ? 0.5 : 0.4; /* of s F_e, the stored energy */
    const double approach = -v3_dot(n, u), closing = approach - v3_dot(n, du);
    const double now = closing > last ? closing : last, touch = now > 0.0 ? now : 0.0;
    const double stored2 = 2.0 * (part * s * elastic) * slow_inv_mass, touch2 = touch * touch;
    const double speed = sqrt(stored2 > touch2 ? stored2 : touch2);
    const double chi = speed > 0.0 ? impact_damping / speed : 0.0;
    const double from = s - by.dt * approach, previous = from > 0.0 ? from : 0.0;
    const double end_speed =
        fl_damping_end_speed(closing, chi * elastic, by.half * inv_mass, contact_count,
                             elastic - k * (previous * (linear ? 1.0 : sqrt(previous))), before, by.at_start);
    const double damping = elastic * (chi * end_speed);
    q.max_approach_speed = touch;
    q.damping_factor = chi;
    q.normal_damping = damping > -elastic ? damping : -elastic;
    return q;
}

/* Tangential velocity at the contact: u of the centres, turn = a_i w_i + a_j w_j. */
FL_SIMD_INLINE fl_vec3 fl_sphere_tangential_velocity(fl_vec3 u, fl_vec3 turn, fl_vec3 n)
{
    const fl_vec3 s = v3_sub(u, v3_cross(turn, n));
    return v3_madd(s, -v3_dot(s, n), n);
}

/* Spring of friction and tangential force. */
typedef struct {
    fl_vec3 spring_force; /* [N] */
    double spring_stiffness;
    fl_vec3 friction_force; /* F_t [N] */
} fl_sphere_friction;

/* spring_force, spring_stiffness, friction_force: of the step before; c: k_t, g, the limit mu F_n, and the
 * inverse mass without the spheres' rotation; inv_inertia: r_i^2/I_i + r_j^2/I_j; on: 0 without friction. */
FL_SIMD_INLINE fl_sphere_friction fl_sphere_friction_of(fl_vec3 n, double overlap, double ri, double rj,
                                                        fl_vec3 u, fl_vec3 du, fl_vec3 wi, fl_vec3 wj,
                                                        fl_vec3 rdw, fl_sphere_friction before,
                                                        fl_tangent_spring c, double inv_inertia, int on,
                                                        fl_sphere_step by)
{
    fl_sphere_friction q;
    const double half = 0.5 * overlap, ai = ri - half, aj = rj - half, part = (ai + aj) / (ri + rj);
    const fl_vec3 v = fl_sphere_tangential_velocity(u, v3_madd(v3_scale(ai, wi), aj, wj), n),
                  next = v3_add(v, fl_sphere_tangential_velocity(du, v3_scale(part, rdw), n));
    const double twist = by.dt * (0.5 * v3_dot(v3_add(wi, wj), n));
    /* the remembered force rotates about n and is projected into the tangent plane */
    const fl_vec3 p = before.spring_force, t = v3_madd(p, twist, v3_cross(n, p)),
                  turned = v3_madd(t, -v3_dot(t, n), n), r = v3_sub(before.friction_force, p),
                  previous_damping = v3_madd(r, -v3_dot(r, n), n);
    c.inv_mass = c.inv_mass + part * part * inv_inertia;
    const fl_friction_forces now = fl_tangent_point_step(p, turned, before.spring_stiffness, c, v, next,
                                                         previous_damping, by.dt, by.half, by.at_start);
    const fl_vec3 e = now.elastic.f, total = now.total.f;
    q.spring_force = v3(on ? e.x : 0.0, on ? e.y : 0.0, on ? e.z : 0.0);
    q.spring_stiffness = on ? c.k : 0.0;
    q.friction_force = v3(on ? total.x : 0.0, on ? total.y : 0.0, on ? total.z : 0.0);
    return q;
}

/* Forces and torques on the two. */
typedef struct {
    fl_vec3 elastic, damping; /* F_e n, (F_n - F_e) n, on i [N] */
    fl_vec3 ti, tj;           /* torques of F_t [N m] */
    double magnitude;         /* |F| [N] */
} fl_sphere_forces;

FL_SIMD_INLINE fl_sphere_forces fl_sphere_forces_of(fl_vec3 n, double overlap, double ri, double rj,
                                                    double elastic, double damping, fl_vec3 friction)
{
    fl_sphere_forces q;
    const double x = friction.x, y = friction.y, z = friction.z;
    const double tx = n.z * y - n.y * z, ty = n.x * z - n.z * x, tz = n.y * x - n.x * y; /* F_t x n */
    const double half = 0.5 * overlap, ai = ri - half, aj = rj - half, f = elastic + damping;
    q.elastic = v3(elastic * n.x, elastic * n.y, elastic * n.z);
    q.damping = v3(damping * n.x, damping * n.y, damping * n.z);
    q.ti = v3(ai * tx, ai * ty, ai * tz);
    q.tj = v3(aj * tx, aj * ty, aj * tz);
    q.magnitude = sqrt(f * f + (x * x + y * y + z * z));
    return q;
}

/* Rolling resistance.  before: its spring; c: as in rolling.h; dw: predicted change of w_i - w_j. */
FL_SIMD_INLINE fl_rolling_spring fl_sphere_rolling_of(fl_rolling_spring before, fl_tangent_spring c,
                                                      fl_vec3 wi, fl_vec3 wj, fl_vec3 dw, fl_sphere_step by)
{
    const double arm = before.arm;
    const fl_vec3 arm_spin = v3_scale(arm, v3_sub(wi, wj));
    const fl_rolling_motion motion = {arm_spin, v3_madd(arm_spin, arm, dw), v3_scale(0.5, v3_add(wi, wj))};
    const fl_rolling_spring now = fl_rolling_step(before, c, motion, by.dt, by.half, by.at_start);
    const int on = c.limit > 0.0;
    fl_rolling_spring q;
    q.elastic = v3(on ? now.elastic.x : 0.0, on ? now.elastic.y : 0.0, on ? now.elastic.z : 0.0);
    q.k = on ? now.k : 0.0;
    q.total = v3(on ? now.total.x : 0.0, on ? now.total.y : 0.0, on ? now.total.z : 0.0);
    q.arm = arm;
    return q;
}

/* Contacts that damp two bodies, as fl_effective_contact_count(), in the order of operations of lanes. */
FL_SIMD_INLINE double fl_sphere_contact_count(double ni, double nj, double inv_mass)
{
    return inv_mass > 0.0 ? 1.0 + (ni + nj) / inv_mass : 1.0 + 0.0;
}

#endif
