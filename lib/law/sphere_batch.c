/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/simd.h"
#include "law/damping.h"
#include "law/sphere_batch.h"
#include "law/tangent.h"

/* Registers are filled: contacts after the last one are computed as well and not used. */
enum { REGISTER = 8 };
static int32_t padded_count(int32_t m) { return (m + REGISTER - 1) / REGISTER * REGISTER; }

/* The loops have no branches, so that the compiler vectorises them over contacts. */
#define SIMD_LOOP _Pragma("omp simd")

FL_SIMD_VERSIONS static void find_geometry(fl_sphere_batch *restrict b, int32_t m)
{
    const int linear = b->exponent == 1.0;
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const double x = b->d[0][c], y = b->d[1][c], z = b->d[2][c];
        const double d = sqrt(x * x + y * y + z * z), inverse = d > 0.0 ? 1.0 / d : 0.0;
        const double s = b->ri[c] + b->rj[c] - d, root = linear ? (s > 0.0 ? 1.0 : 0.0) : sqrt(s > 0.0 ? s : 0.0);
        b->n[0][c] = inverse * x;
        b->n[1][c] = inverse * y;
        b->n[2][c] = d > 0.0 ? inverse * z : 1.0;
        b->overlap[c] = s;
        b->elastic[c] = b->k[c] * (s * root);
        b->slope[c] = b->k[c] * ((linear ? 1.0 : 1.5) * root);
    }
}

/* Tangential velocity at the contact: u of the centres, turn = a_i w_i + a_j w_j. */
FL_SIMD_INLINE fl_vec3 tangential_velocity(fl_vec3 u, fl_vec3 turn, fl_vec3 n)
{
    const fl_vec3 s = v3_sub(u, v3_cross(turn, n));
    return v3_madd(s, -v3_dot(s, n), n);
}

#define VECTOR(a) v3(b->a[0][c], b->a[1][c], b->a[2][c])

FL_SIMD_VERSIONS static void find_normal_forces(fl_sphere_batch *restrict b, int32_t m, double dt, double h,
                                                double at_start)
{
    const int linear = b->exponent == 1.0;
    const double part = linear ? 0.5 : 0.4; /* of s F_e, the stored energy */
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 n = VECTOR(n), u = VECTOR(u);
        const double s = b->overlap[c], elastic = b->elastic[c], last = b->max_approach_speed[c];
        const double approach = -v3_dot(n, u), closing = approach - v3_dot(n, VECTOR(du));
        const double now = closing > last ? closing : last, touch = now > 0.0 ? now : 0.0;
        const double stored2 = 2.0 * (part * s * elastic) * b->slow_inv_mass[c], touch2 = touch * touch;
        const double speed = sqrt(stored2 > touch2 ? stored2 : touch2);
        const double chi = speed > 0.0 ? b->impact_damping[c] / speed : 0.0;
        const double from = s - dt * approach, previous = from > 0.0 ? from : 0.0;
        const double end_speed = fl_damping_end_speed(
            closing, chi * elastic, h * b->inv_mass[c], b->contact_count[c],
            elastic - b->k[c] * (previous * (linear ? 1.0 : sqrt(previous))), b->normal_damping[c], at_start);
        const double damping = elastic * (chi * end_speed);
        b->max_approach_speed[c] = touch;
        b->damping_factor[c] = chi;
        b->normal_damping[c] = damping > -elastic ? damping : -elastic;
    }
}

FL_SIMD_VERSIONS static void find_friction(fl_sphere_batch *restrict b, int32_t m, double dt, double h,
                                           double at_start)
{
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 n = VECTOR(n), u = VECTOR(u), wi = VECTOR(wi), wj = VECTOR(wj);
        const double ri = b->ri[c], rj = b->rj[c], half = 0.5 * b->overlap[c], ai = ri - half, aj = rj - half,
                     part = (ai + aj) / (ri + rj);
        const fl_vec3 v = tangential_velocity(u, v3_madd(v3_scale(ai, wi), aj, wj), n),
                      next = v3_add(v, tangential_velocity(VECTOR(du), v3_scale(part, VECTOR(rdw)), n));
        const double twist = dt * (0.5 * v3_dot(v3_add(wi, wj), n));
        /* the remembered force rotates about n and is projected into the tangent plane */
        const fl_vec3 p = VECTOR(spring_force), t = v3_madd(p, twist, v3_cross(n, p)),
                      q = v3_madd(t, -v3_dot(t, n), n), r = v3_sub(VECTOR(friction_force), p),
                      previous_damping = v3_madd(r, -v3_dot(r, n), n);
        const fl_tangent_spring spring = {.k = b->tangential[c] * b->slope[c],
                                          .g = b->tangential[c] * (b->damping_factor[c] * b->elastic[c]),
                                          .limit = b->friction[c] * (b->elastic[c] + b->normal_damping[c]),
                                          .inv_mass =
                                              b->inv_mass_tangent[c] + part * part * b->inv_inertia[c],
                                          .contact_count = b->contact_count[c]};
        const fl_friction_forces now = fl_tangent_point_step(p, q, b->spring_stiffness[c], spring, v, next,
                                                             previous_damping, dt, h, at_start);
        const fl_vec3 e = now.elastic.f, total = now.total.f;
        const int on = spring.limit > 0.0 && b->tangential[c] > 0.0;
        b->spring_force[0][c] = on ? e.x : 0.0;
        b->spring_force[1][c] = on ? e.y : 0.0;
        b->spring_force[2][c] = on ? e.z : 0.0;
        b->spring_stiffness[c] = on ? spring.k : 0.0;
        b->friction_force[0][c] = on ? total.x : 0.0;
        b->friction_force[1][c] = on ? total.y : 0.0;
        b->friction_force[2][c] = on ? total.z : 0.0;
    }
}

FL_SIMD_VERSIONS static void find_forces(fl_sphere_batch *restrict b, int32_t m)
{
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const double nx = b->n[0][c], ny = b->n[1][c], nz = b->n[2][c];
        const double x = b->friction_force[0][c], y = b->friction_force[1][c], z = b->friction_force[2][c];
        const double tx = nz * y - ny * z, ty = nx * z - nz * x, tz = ny * x - nx * y; /* F_t x n */
        const double half = 0.5 * b->overlap[c], ai = b->ri[c] - half, aj = b->rj[c] - half;
        const double elastic = b->elastic[c], damping = b->normal_damping[c], f = elastic + damping;
        b->elastic_force[0][c] = elastic * nx;
        b->elastic_force[1][c] = elastic * ny;
        b->elastic_force[2][c] = elastic * nz;
        b->damping_force[0][c] = damping * nx;
        b->damping_force[1][c] = damping * ny;
        b->damping_force[2][c] = damping * nz;
        b->ti[0][c] = ai * tx;
        b->ti[1][c] = ai * ty;
        b->ti[2][c] = ai * tz;
        b->tj[0][c] = aj * tx;
        b->tj[1][c] = aj * ty;
        b->tj[2][c] = aj * tz;
        b->magnitude[c] = sqrt(f * f + (x * x + y * y + z * z));
    }
}

FL_SIMD_VERSIONS static void find_rolling(const fl_sphere_batch *restrict b,
                                          fl_sphere_rolling_batch *restrict r, int32_t m, double dt, double h,
                                          double at_start)
{
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_vec3 wi = VECTOR(wi), wj = VECTOR(wj);
        const double mu = r->rolling[c], part = fl_rolling_stiffness_ratio(mu), arm = r->arm[c];
        const fl_tangent_spring spring = {.k = part * b->slope[c],
                                          .g = part * (b->damping_factor[c] * b->elastic[c]),
                                          .limit = mu * (b->elastic[c] + b->normal_damping[c]),
                                          .inv_mass = r->inv_mass[c],
                                          .contact_count = b->contact_count[c]};
        const fl_vec3 arm_spin = v3_scale(arm, v3_sub(wi, wj));
        const fl_rolling_motion by = {arm_spin,
                                      v3_madd(arm_spin, arm, v3(r->dw[0][c], r->dw[1][c], r->dw[2][c])),
                                      v3_scale(0.5, v3_add(wi, wj))};
        const fl_rolling_spring before = {v3(r->elastic[0][c], r->elastic[1][c], r->elastic[2][c]),
                                          r->spring_stiffness[c],
                                          v3(r->total[0][c], r->total[1][c], r->total[2][c]), arm};
        const fl_rolling_spring now = fl_rolling_step(before, spring, by, dt, h, at_start);
        const int on = spring.limit > 0.0;
        r->elastic[0][c] = on ? now.elastic.x : 0.0;
        r->elastic[1][c] = on ? now.elastic.y : 0.0;
        r->elastic[2][c] = on ? now.elastic.z : 0.0;
        r->spring_stiffness[c] = on ? now.k : 0.0;
        r->total[0][c] = on ? now.total.x : 0.0;
        r->total[1][c] = on ? now.total.y : 0.0;
        r->total[2][c] = on ? now.total.z : 0.0;
    }
}

void fl_sphere_batch_add_rolling(fl_sphere_batch *b, const fl_sphere_rolling_batch *r, int32_t m)
{
    for (int axis = 0; axis < 3; axis++) {
        for (int32_t c = 0; c < m; c++) {
            b->ti[axis][c] += r->arm[c] * r->total[axis][c];
            b->tj[axis][c] -= r->arm[c] * r->total[axis][c];
        }
    }
}

void fl_sphere_batch_rolling(fl_sphere_batch *b, fl_sphere_rolling_batch *r, int32_t m, double dt,
                             double half)
{
    find_rolling(b, r, padded_count(m), dt, half, dt > 0.0 ? 0.0 : 1.0);
    fl_sphere_batch_add_rolling(b, r, m);
}

void fl_sphere_batch_evaluate(fl_sphere_batch *b, int32_t m, double dt, double half)
{
    const int32_t full = padded_count(m);
    const double at_start = dt > 0.0 ? 0.0 : 1.0;
    find_geometry(b, full);
    find_normal_forces(b, full, dt, half, at_start);
    find_friction(b, full, dt, half, at_start);
    find_forces(b, full);
}

void fl_sphere_batch_restore(fl_sphere_batch *b, int32_t m)
{
    const int32_t full = padded_count(m);
    find_geometry(b, full);
    find_forces(b, full);
}
