/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "law/sphere_batch.h"
#include "base/simd.h"
#include "law/sphere_kernel.h"

/* Registers are filled: contacts after the last one are computed as well and not used. */
enum { REGISTER = 8 };
static int32_t padded_count(int32_t m) { return (m + REGISTER - 1) / REGISTER * REGISTER; }

/* The loops have no branches, so that the compiler vectorises them over contacts. */
#define SIMD_LOOP _Pragma("omp simd")

#define VECTOR(a) v3(b->a[0][c], b->a[1][c], b->a[2][c])
#define SET_VECTOR(a, v) (b->a[0][c] = (v).x, b->a[1][c] = (v).y, b->a[2][c] = (v).z)

FL_SIMD_VERSIONS static void find_geometry(fl_sphere_batch *restrict b, int32_t m)
{
    const int linear = b->exponent == 1.0;
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_sphere_geometry g =
            fl_sphere_geometry_of(b->d[0][c], b->d[1][c], b->d[2][c], b->ri[c], b->rj[c], b->k[c], linear);
        SET_VECTOR(n, g.n);
        b->overlap[c] = g.overlap;
        b->elastic[c] = g.elastic;
        b->slope[c] = g.slope;
    }
}

FL_SIMD_VERSIONS static void find_normal_forces(fl_sphere_batch *restrict b, int32_t m, double dt, double h,
                                                double at_start)
{
    const int linear = b->exponent == 1.0;
    const fl_sphere_step by = {dt, h, at_start};
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_sphere_normal q =
            fl_sphere_normal_of(VECTOR(n), b->overlap[c], b->elastic[c], b->k[c], VECTOR(u), VECTOR(du),
                                b->max_approach_speed[c], b->normal_damping[c], b->slow_inv_mass[c],
                                b->impact_damping[c], b->inv_mass[c], b->contact_count[c], by, linear);
        b->max_approach_speed[c] = q.max_approach_speed;
        b->damping_factor[c] = q.damping_factor;
        b->normal_damping[c] = q.normal_damping;
    }
}

FL_SIMD_VERSIONS static void find_friction(fl_sphere_batch *restrict b, int32_t m, double dt, double h,
                                           double at_start)
{
    const fl_sphere_step by = {dt, h, at_start};
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_sphere_friction before = {VECTOR(spring_force), b->spring_stiffness[c],
                                           VECTOR(friction_force)};
        const fl_tangent_spring spring = {.k = b->tangential[c] * b->slope[c],
                                          .g = b->tangential[c] * (b->damping_factor[c] * b->elastic[c]),
                                          .limit = b->friction[c] * (b->elastic[c] + b->normal_damping[c]),
                                          .inv_mass = b->inv_mass_tangent[c],
                                          .contact_count = b->contact_count[c]};
        const int on = spring.limit > 0.0 && b->tangential[c] > 0.0;
        const fl_sphere_friction now = fl_sphere_friction_of(
            VECTOR(n), b->overlap[c], b->ri[c], b->rj[c], VECTOR(u), VECTOR(du), VECTOR(wi), VECTOR(wj),
            VECTOR(rdw), before, spring, b->inv_inertia[c], on, by);
        SET_VECTOR(spring_force, now.spring_force);
        b->spring_stiffness[c] = now.spring_stiffness;
        SET_VECTOR(friction_force, now.friction_force);
    }
}

FL_SIMD_VERSIONS static void find_forces(fl_sphere_batch *restrict b, int32_t m)
{
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const fl_sphere_forces q =
            fl_sphere_forces_of(VECTOR(n), b->overlap[c], b->ri[c], b->rj[c], b->elastic[c],
                                b->normal_damping[c], VECTOR(friction_force));
        SET_VECTOR(elastic_force, q.elastic);
        SET_VECTOR(damping_force, q.damping);
        SET_VECTOR(ti, q.ti);
        SET_VECTOR(tj, q.tj);
        b->magnitude[c] = q.magnitude;
    }
}

FL_SIMD_VERSIONS static void find_rolling(const fl_sphere_batch *restrict b,
                                          fl_sphere_rolling_batch *restrict r, int32_t m, double dt, double h,
                                          double at_start)
{
    const fl_sphere_step by = {dt, h, at_start};
    SIMD_LOOP for (int32_t c = 0; c < m; c++)
    {
        const double mu = r->rolling[c], part = fl_rolling_stiffness_ratio(mu);
        const fl_tangent_spring spring = {.k = part * b->slope[c],
                                          .g = part * (b->damping_factor[c] * b->elastic[c]),
                                          .limit = mu * (b->elastic[c] + b->normal_damping[c]),
                                          .inv_mass = r->inv_mass[c],
                                          .contact_count = b->contact_count[c]};
        const fl_rolling_spring before = {v3(r->elastic[0][c], r->elastic[1][c], r->elastic[2][c]),
                                          r->spring_stiffness[c],
                                          v3(r->total[0][c], r->total[1][c], r->total[2][c]), r->arm[c]};
        const fl_rolling_spring now = fl_sphere_rolling_of(before, spring, VECTOR(wi), VECTOR(wj),
                                                           v3(r->dw[0][c], r->dw[1][c], r->dw[2][c]), by);
        r->elastic[0][c] = now.elastic.x;
        r->elastic[1][c] = now.elastic.y;
        r->elastic[2][c] = now.elastic.z;
        r->spring_stiffness[c] = now.k;
        r->total[0][c] = now.total.x;
        r->total[1][c] = now.total.y;
        r->total[2][c] = now.total.z;
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
