/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "body/body_batch.h"

static void unpack_one(double (*to)[FL_BODY_BATCH], fl_vec3 a, int32_t k)
{
    to[0][k] = a.x, to[1][k] = a.y, to[2][k] = a.z;
}

static fl_vec3 pack_one(const double (*from)[FL_BODY_BATCH], int32_t k)
{
    return v3(from[0][k], from[1][k], from[2][k]);
}

/* q_matrix() on lanes. */
FL_SIMD_VERSIONS void fl_body_batch_update_axes(fl_body_batch *restrict s)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double w = s->q[0][i], x = s->q[1][i], y = s->q[2][i], z = s->q[3][i];
        const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z, wx = w * x,
                     wy = w * y, wz = w * z;
        s->R[0][i] = 1 - 2 * (yy + zz), s->R[1][i] = 2 * (xy - wz), s->R[2][i] = 2 * (xz + wy);
        s->R[3][i] = 2 * (xy + wz), s->R[4][i] = 1 - 2 * (xx + zz), s->R[5][i] = 2 * (yz - wx);
        s->R[6][i] = 2 * (xz - wy), s->R[7][i] = 2 * (yz + wx), s->R[8][i] = 1 - 2 * (xx + yy);
    }
}

FL_SIMD_VERSIONS static void fill_steps(double *h, double of)
{
#pragma omp simd
    for (int32_t k = 0; k < FL_BODY_BATCH; k++) h[k] = of;
}

FL_SIMD4_VERSIONS static void load_contiguous(fl_body_batch *s, const fl_bodies *b, int32_t from)
{
    const double *m = b->m + from, *invm = b->invm + from;
    const fl_vec3 *invI = b->invI + from, *v = b->v + from, *L = b->L + from, *w = b->w + from;
    const fl_quat *q = b->q + from;
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        FL_SIMD_STORE(&s->m[k]) = FL_SIMD_LOAD(&m[k]);
        FL_SIMD_STORE(&s->invm[k]) = FL_SIMD_LOAD(&invm[k]);
        fl_body_batch_unpack_vec(s->invI, invI, k);
        fl_body_batch_unpack_vec(s->v, v, k);
        fl_body_batch_unpack_vec(s->L, L, k);
        fl_body_batch_unpack_vec(s->w, w, k);
        fl_body_batch_unpack4(s->q, q, sizeof *q, k);
    }
}

FL_SIMD4_VERSIONS static void load_gathered(fl_body_batch *s, const fl_bodies *b)
{
    for (int32_t k = 0; k < s->lanes; k++) {
        const int32_t i = s->index[k];
        s->m[k] = b->m[i], s->invm[k] = b->invm[i];
        unpack_one(s->invI, b->invI[i], k), unpack_one(s->v, b->v[i], k);
        unpack_one(s->L, b->L[i], k), unpack_one(s->w, b->w[i], k);
    }
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH)
        fl_body_batch_gather4(s->q, b->q, sizeof *b->q, s->index, k);
}

void fl_body_batch_load(fl_body_batch *s, const fl_bodies *b, int32_t *at, int32_t n, double h)
{
    s->n = n;
    s->lanes = (n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    s->contiguous = n == s->lanes && at[n - 1] - at[0] == n - 1;
    s->index = at;
    fill_steps(s->h, h);
    if (s->contiguous) {
        load_contiguous(s, b, at[0]);
        return;
    }
    for (int32_t k = n; k < s->lanes; k++) at[k] = at[n - 1];
    load_gathered(s, b);
}

FL_SIMD4_VERSIONS static void load_contiguous_forces(fl_body_batch *s, const fl_vec3 *f, const fl_vec3 *t)
{
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        fl_body_batch_unpack_vec(s->f, f, k);
        fl_body_batch_unpack_vec(s->t, t, k);
    }
}

void fl_body_batch_load_forces(fl_body_batch *s, const fl_bodies *b)
{
    if (s->contiguous) load_contiguous_forces(s, &b->f[s->index[0]], &b->t[s->index[0]]);
    for (int32_t k = 0; k < s->lanes && !s->contiguous; k++) fl_body_batch_load_force(s, b, k);
}

FL_SIMD4_VERSIONS static void load_contiguous_pose(fl_body_batch *s, const fl_vec3 *x, const double *odometer,
                                                   const double *bound)
{
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        fl_body_batch_unpack_vec(s->x, x, k);
        FL_SIMD_STORE(&s->odometer[k]) = FL_SIMD_LOAD(&odometer[k]);
        FL_SIMD_STORE(&s->bounding_radius[k]) = FL_SIMD_LOAD(&bound[k]);
    }
}

void fl_body_batch_load_pose(fl_body_batch *s, const fl_bodies *b)
{
    const int32_t from = s->index[0];
    if (s->contiguous) load_contiguous_pose(s, &b->x[from], &b->odometer[from], &b->bounding_radius[from]);
    for (int32_t k = 0; k < s->lanes && !s->contiguous; k++) {
        const int32_t i = s->index[k];
        unpack_one(s->x, b->x[i], k);
        s->odometer[k] = b->odometer[i], s->bounding_radius[k] = b->bounding_radius[i];
    }
}

void fl_body_batch_load_water(fl_body_batch_water *a, const fl_bodies *b, const fl_body_batch *s)
{
    for (int32_t k = 0; k < s->lanes; k++) {
        const int32_t i = s->index[k];
        unpack_one(a->added_mass, b->added_mass[i], k), unpack_one(a->flow_velocity, b->flow_velocity[i], k);
        a->flow_work[k] = b->flow_work[i];
    }
}

void fl_body_batch_store_water(const fl_body_batch *s, const fl_body_batch_water *a, fl_bodies *b)
{
    for (int32_t k = 0; k < s->n; k++) b->flow_work[s->index[k]] = a->flow_work[k];
}

FL_SIMD4_VERSIONS static void store_contiguous_forces(const fl_body_batch *s, fl_vec3 *f, fl_vec3 *t)
{
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        fl_body_batch_pack_vec(f, s->f, k);
        fl_body_batch_pack_vec(t, s->t, k);
    }
}

void fl_body_batch_store_forces(const fl_body_batch *s, fl_bodies *b)
{
    if (s->contiguous) store_contiguous_forces(s, &b->f[s->index[0]], &b->t[s->index[0]]);
    for (int32_t k = 0; k < s->n && !s->contiguous; k++)
        b->f[s->index[k]] = pack_one(s->f, k), b->t[s->index[k]] = pack_one(s->t, k);
}

FL_SIMD4_VERSIONS static void store_contiguous_velocities(const fl_body_batch *s, fl_vec3 *v, fl_vec3 *L,
                                                          fl_vec3 *w)
{
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        fl_body_batch_pack_vec(v, s->v, k);
        fl_body_batch_pack_vec(L, s->L, k);
        fl_body_batch_pack_vec(w, s->w, k);
    }
}

void fl_body_batch_store_velocities(const fl_body_batch *s, fl_bodies *b)
{
    const int32_t from = s->index[0];
    if (s->contiguous) store_contiguous_velocities(s, &b->v[from], &b->L[from], &b->w[from]);
    for (int32_t k = 0; k < s->n && !s->contiguous; k++) {
        const int32_t i = s->index[k];
        b->v[i] = pack_one(s->v, k), b->L[i] = pack_one(s->L, k), b->w[i] = pack_one(s->w, k);
    }
}

FL_SIMD4_VERSIONS static void store_contiguous_pose(const fl_body_batch *s, fl_vec3 *x, fl_quat *q,
                                                    double *odometer)
{
    for (int32_t k = 0; k < s->lanes; k += FL_SIMD_WIDTH) {
        fl_body_batch_pack_vec(x, s->x, k);
        fl_body_batch_pack4(q, sizeof *q, s->q, k);
        FL_SIMD_STORE(&odometer[k]) = FL_SIMD_LOAD(&s->odometer[k]);
    }
}

void fl_body_batch_store_pose(const fl_body_batch *s, fl_bodies *b)
{
    const int32_t from = s->index[0];
    if (s->contiguous) store_contiguous_pose(s, &b->x[from], &b->q[from], &b->odometer[from]);
    for (int32_t k = 0; k < s->n && !s->contiguous; k++) {
        const int32_t i = s->index[k];
        b->x[i] = pack_one(s->x, k);
        b->q[i] = (fl_quat){s->q[0][k], s->q[1][k], s->q[2][k], s->q[3][k]};
        b->odometer[i] = s->odometer[k];
    }
}

FL_SIMD_VERSIONS void fl_body_batch_set_weight(fl_body_batch *restrict s, fl_vec3 gravity)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        s->f[0][i] = s->m[i] * gravity.x;
        s->f[1][i] = s->m[i] * gravity.y;
        s->f[2][i] = s->m[i] * gravity.z;
        s->t[0][i] = 0.0;
        s->t[1][i] = 0.0;
        s->t[2][i] = 0.0;
    }
}

FL_SIMD_VERSIONS void fl_body_batch_kick_momentum(fl_body_batch *restrict s)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double h = s->h[i], by = h * s->invm[i];
        s->v[0][i] += by * s->f[0][i];
        s->v[1][i] += by * s->f[1][i];
        s->v[2][i] += by * s->f[2][i];
        s->L[0][i] += h * s->t[0][i];
        s->L[1][i] += h * s->t[1][i];
        s->L[2][i] += h * s->t[2][i];
    }
}

/* Change of v by the force in h seconds. a: NULL without added mass. */
FL_SIMD_INLINE fl_vec3 velocity_gain(const fl_body_batch *s, const fl_body_batch_water *a, int32_t i)
{
    const double h = s->h[i];
    const fl_vec3 f = FL_BODY_BATCH_VEC(s->f, i);
    if (!a) return v3_scale(h * s->invm[i], f);
    return v3_scale(
        h, fl_body_batch_velocity(fl_body_batch_axes(s, i), s->m[i], FL_BODY_BATCH_VEC(a->added_mass, i), f));
}

FL_SIMD_INLINE void kick_lanes(fl_body_batch *restrict s, const fl_body_batch_water *restrict water)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double h = s->h[i];
        fl_body_batch_set_vec(s->v, i, v3_add(FL_BODY_BATCH_VEC(s->v, i), velocity_gain(s, water, i)));
        const double x = s->L[0][i] + h * s->t[0][i], y = s->L[1][i] + h * s->t[1][i],
                     z = s->L[2][i] + h * s->t[2][i];
        s->L[0][i] = x;
        s->L[1][i] = y;
        s->L[2][i] = z;
        const double a = s->invI[0][i] * (s->R[0][i] * x + s->R[3][i] * y + s->R[6][i] * z),
                     b = s->invI[1][i] * (s->R[1][i] * x + s->R[4][i] * y + s->R[7][i] * z),
                     c = s->invI[2][i] * (s->R[2][i] * x + s->R[5][i] * y + s->R[8][i] * z);
        s->w[0][i] = s->R[0][i] * a + s->R[1][i] * b + s->R[2][i] * c;
        s->w[1][i] = s->R[3][i] * a + s->R[4][i] * b + s->R[5][i] * c;
        s->w[2][i] = s->R[6][i] * a + s->R[7][i] * b + s->R[8][i] * c;
    }
}

FL_SIMD_VERSIONS static void kick_free_lanes(fl_body_batch *s) { kick_lanes(s, NULL); }
FL_SIMD_VERSIONS static void kick_lanes_with_water(fl_body_batch *s, const fl_body_batch_water *a)
{
    kick_lanes(s, a);
}

void fl_body_batch_kick(fl_body_batch *s, const fl_body_batch_water *a)
{
    if (a) kick_lanes_with_water(s, a);
    else kick_free_lanes(s);
}

FL_SIMD_INLINE void velocity_changes(const fl_body_batch *restrict s,
                                     const fl_body_batch_water *restrict water,
                                     double (*restrict g)[FL_BODY_BATCH])
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double h = s->h[i], x = h * s->t[0][i], y = h * s->t[1][i], z = h * s->t[2][i];
        const double a = s->invI[0][i] * (s->R[0][i] * x + s->R[3][i] * y + s->R[6][i] * z),
                     b = s->invI[1][i] * (s->R[1][i] * x + s->R[4][i] * y + s->R[7][i] * z),
                     c = s->invI[2][i] * (s->R[2][i] * x + s->R[5][i] * y + s->R[8][i] * z);
        fl_body_batch_set_vec(g, i, velocity_gain(s, water, i));
        g[3][i] = s->R[0][i] * a + s->R[1][i] * b + s->R[2][i] * c;
        g[4][i] = s->R[3][i] * a + s->R[4][i] * b + s->R[5][i] * c;
        g[5][i] = s->R[6][i] * a + s->R[7][i] * b + s->R[8][i] * c;
    }
}

FL_SIMD_VERSIONS static void changes_free(const fl_body_batch *s, double (*g)[FL_BODY_BATCH])
{
    velocity_changes(s, NULL, g);
}
FL_SIMD_VERSIONS static void changes_with_water(const fl_body_batch *s, const fl_body_batch_water *a,
                                                double (*g)[FL_BODY_BATCH])
{
    velocity_changes(s, a, g);
}

void fl_body_batch_velocity_change(const fl_body_batch *s, const fl_body_batch_water *a,
                                   double (*g)[FL_BODY_BATCH])
{
    if (a) changes_with_water(s, a, g);
    else changes_free(s, g);
}

/* Margin of max_turn2() over the angles that the three rotations compute.  In exact arithmetic none of them
 * is larger.  Each is some 30 operations away from the bound and q is normal to rounding, so that they may
 * exceed it by 30 * 2^-53 = 3e-15 of itself.  1e-9 is far above that, and moves the choice of series by no
 * more than that part. */
#define ROUNDING_MARGIN 1e-9

/* Upper bound of the squared angle [rad2] that any body turns in its step at the angular momenta L. */
FL_SIMD_VERSIONS static double max_turn2(const fl_body_batch *restrict s, double (*restrict L)[FL_BODY_BATCH])
{
    double most = 0.0;
#pragma omp simd reduction(max : most)
    for (int32_t i = 0; i < s->lanes; i++) {
        const double dt = 2.0 * s->h[i], x = dt * L[0][i], y = dt * L[1][i], z = dt * L[2][i],
                     e0 = s->invI[0][i], e1 = s->invI[1][i], e2 = s->invI[2][i], e01 = e0 > e1 ? e0 : e1,
                     ease = e01 > e2 ? e01 : e2;
        const double turn2 = (ease * ease) * (x * x + y * y + z * z);
        most = turn2 > most ? turn2 : most;
    }
    return most;
}

static inline double versine_of(double x2, int small) { return small ? q_versine_small(x2) : q_versine(x2); }
static inline double sinc_of(double x2, int small) { return small ? q_sinc_small(x2) : q_sinc(x2); }

/* Moves body i straight on for dt seconds. */
FL_SIMD_INLINE void advance_position(fl_body_batch *s, int32_t i, double dt)
{
    const double vx = s->v[0][i], vy = s->v[1][i], vz = s->v[2][i];
    s->x[0][i] += dt * vx;
    s->x[1][i] += dt * vy;
    s->x[2][i] += dt * vz;
    s->odometer[i] += fabs(dt) * sqrt(vx * vx + vy * vy + vz * vz);
}

/* fl_drift(): the three rotations of fl_drift_rotation(), each in its own loop. A rotation depends on the one
 * before it, so one loop over all of them would wait on latency. small: no half angle squared exceeds
 * Q_HALF_ANGLE2_SMALL.
 *
 * First rotation, about axis 0. straight: translate as well. from: q before it. w: its share of the mean
 * angular velocity. */
FL_SIMD_INLINE void turn_first_axis(fl_body_batch *restrict s, int small, int straight,
                                    double (*restrict from)[FL_BODY_BATCH])
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double h = s->h[i];
        if (straight) advance_position(s, i, 2.0 * h);
        const double Lx = s->L[0][i], Ly = s->L[1][i], Lz = s->L[2][i];
        const double a0 = h * (s->invI[0][i] - s->invI[1][i]);
        const double ow = s->q[0][i], ox = s->q[1][i], oy = s->q[2][i], oz = s->q[3][i];
        const double ex = 1 - 2 * (oy * oy + oz * oz), ey = 2 * (ox * oy + ow * oz),
                     ez = 2 * (ox * oz - ow * oy);
        const double l0 = ex * Lx + ey * Ly + ez * Lz, r0 = a0 * l0, v0 = 0.25 * r0 * r0;
        const double c0 = 1.0 - versine_of(v0, small), s0 = sinc_of(v0, small) * (0.5 * r0);
        from[0][i] = ow, from[1][i] = ox, from[2][i] = oy, from[3][i] = oz;
        s->q[0][i] = ow * c0 - ox * s0, s->q[1][i] = ow * s0 + ox * c0;
        s->q[2][i] = oy * c0 + oz * s0, s->q[3][i] = oz * c0 - oy * s0;
        s->w[0][i] = l0 * ex, s->w[1][i] = l0 * ey, s->w[2][i] = l0 * ez;
    }
}

/* Symmetric top: rotation about axis 2, then about L. top: its share of the mean angular velocity. */
FL_SIMD_INLINE void turn_symmetric_top(fl_body_batch *restrict s, int small,
                                       double (*restrict top)[FL_BODY_BATCH])
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double dt = 2.0 * s->h[i];
        const double Lx = s->L[0][i], Ly = s->L[1][i], Lz = s->L[2][i], ease1 = s->invI[1][i],
                     more = s->invI[2][i] - ease1, a2 = dt * more;
        const double aw = s->q[0][i], ax = s->q[1][i], ay = s->q[2][i], az = s->q[3][i];
        const double ex = 2 * (ax * az + aw * ay), ey = 2 * (ay * az - aw * ax),
                     ez = 1 - 2 * (ax * ax + ay * ay);
        const double l2 = ex * Lx + ey * Ly + ez * Lz, r2 = a2 * l2, v2 = 0.25 * r2 * r2;
        const double c2 = 1.0 - versine_of(v2, small), s2 = sinc_of(v2, small) * (0.5 * r2);
        const double bw = aw * c2 - az * s2, bx = ax * c2 + ay * s2, by = ay * c2 - ax * s2,
                     bz = az * c2 + aw * s2;
        const double k = dt * ease1, rx = k * Lx, ry = k * Ly, rz = k * Lz;
        const double v1 = 0.25 * (rx * rx + ry * ry + rz * rz);
        const double c1 = 1.0 - versine_of(v1, small), s1 = 0.5 * sinc_of(v1, small);
        const double hx = s1 * rx, hy = s1 * ry, hz = s1 * rz;
        const double dw = c1 * bw - hx * bx - hy * by - hz * bz, dx = c1 * bx + hx * bw + hy * bz - hz * by,
                     dy = c1 * by - hx * bz + hy * bw + hz * bx, dz = c1 * bz + hx * by - hy * bx + hz * bw;
        s->q[0][i] = dw, s->q[1][i] = dx, s->q[2][i] = dy, s->q[3][i] = dz;
        const double half = 0.5 * more * l2;
        top[0][i] = ease1 * Lx + half * (ex + 2 * (dx * dz + dw * dy));
        top[1][i] = ease1 * Ly + half * (ey + 2 * (dy * dz - dw * dx));
        top[2][i] = ease1 * Lz + half * (ez + (1 - 2 * (dx * dx + dy * dy)));
    }
}

/* Axis 0 again. A body without angular momentum keeps its q, to the bit. */
FL_SIMD_INLINE void turn_last_axis(fl_body_batch *restrict s, int small,
                                   double (*restrict from)[FL_BODY_BATCH],
                                   double (*restrict top)[FL_BODY_BATCH])
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const double Lx = s->L[0][i], Ly = s->L[1][i], Lz = s->L[2][i];
        const double less = s->invI[0][i] - s->invI[1][i], a0 = s->h[i] * less;
        const double dw = s->q[0][i], dx = s->q[1][i], dy = s->q[2][i], dz = s->q[3][i];
        const double ax = 1 - 2 * (dy * dy + dz * dz), ay = 2 * (dx * dy + dw * dz),
                     az = 2 * (dx * dz - dw * dy);
        const double l3 = ax * Lx + ay * Ly + az * Lz, r3 = a0 * l3, v3fold = 0.25 * r3 * r3;
        const double c3 = 1.0 - versine_of(v3fold, small), s3 = sinc_of(v3fold, small) * (0.5 * r3);
        const double ew = dw * c3 - dx * s3, ex = dw * s3 + dx * c3, ey = dy * c3 + dz * s3,
                     ez = dz * c3 - dy * s3;
        const double one = 1.5 - 0.5 * (ew * ew + ex * ex + ey * ey + ez * ez);
        const int turns = fabs(Lx) + fabs(Ly) + fabs(Lz) > 0.0;
        const double ow = from[0][i], ox = from[1][i], oy = from[2][i], oz = from[3][i];
        const double qw = turns ? one * ew : ow, qx = turns ? one * ex : ox, qy = turns ? one * ey : oy,
                     qz = turns ? one * ez : oz;
        s->q[0][i] = qw;
        s->q[1][i] = qx;
        s->q[2][i] = qy;
        s->q[3][i] = qz;
        /* the vector part of q conj(old), as q_mul() has it */
        const double fx = qx * ow - qw * ox - qy * oz + qz * oy, fy = qx * oz - qw * oy + qy * ow - qz * ox,
                     fz = qy * ox - (qw * oz + qx * oy) + qz * ow;
        const double chord = 2.0 * sqrt(fx * fx + fy * fy + fz * fz);
        s->odometer[i] = s->odometer[i] + (turns ? chord : 0.0) * s->bounding_radius[i];
        const double half = 0.5 * less, wx = top[0][i] + half * (s->w[0][i] + l3 * ax),
                     wy = top[1][i] + half * (s->w[1][i] + l3 * ay),
                     wz = top[2][i] + half * (s->w[2][i] + l3 * az);
        s->w[0][i] = turns ? wx : 0.0;
        s->w[1][i] = turns ? wy : 0.0;
        s->w[2][i] = turns ? wz : 0.0;
    }
}

FL_SIMD_INLINE void drift_lanes(fl_body_batch *restrict s, int small, int straight)
{
    _Alignas(64) double from[4][FL_BODY_BATCH], top[3][FL_BODY_BATCH];
    turn_first_axis(s, small, straight, from);
    turn_symmetric_top(s, small, top);
    turn_last_axis(s, small, from, top);
}

FL_SIMD_VERSIONS static void drift_small(fl_body_batch *restrict s) { drift_lanes(s, 1, 1); }
FL_SIMD_VERSIONS static void drift_large(fl_body_batch *restrict s) { drift_lanes(s, 0, 1); }
FL_SIMD_VERSIONS static void turn_small(fl_body_batch *restrict s) { drift_lanes(s, 1, 0); }
FL_SIMD_VERSIONS static void turn_large(fl_body_batch *restrict s) { drift_lanes(s, 0, 0); }

/* drift_with_water() of integrate.c: half the translation, the rotation, the other half. */
typedef struct {
    _Alignas(64) double P[3][FL_BODY_BATCH], L[3][FL_BODY_BATCH], carried[FL_BODY_BATCH];
} half_drift;

/* 1/2 U.M_a U */
FL_SIMD_INLINE double flow_energy(fl_rows3 R, fl_vec3 added, fl_vec3 U)
{
    const fl_vec3 u = r3_tmul(R, U);
    return 0.5 * v3_dot(u, v3_mul(added, u));
}

/* P, L after the first half, and the flow energy before it. */
FL_SIMD_VERSIONS static void begin_water_drift(const fl_body_batch *restrict s,
                                               const fl_body_batch_water *restrict a, half_drift *restrict to)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const fl_rows3 R = fl_body_batch_axes(s, i);
        const fl_vec3 added = FL_BODY_BATCH_VEC(a->added_mass, i), U = FL_BODY_BATCH_VEC(a->flow_velocity, i),
                      u = v3_sub(FL_BODY_BATCH_VEC(s->v, i), U),
                      P = fl_body_batch_momentum(R, s->m[i], added, u);
        fl_body_batch_set_vec(to->P, i, P);
        fl_body_batch_set_vec(to->L, i, v3_madd(FL_BODY_BATCH_VEC(s->L, i), s->h[i], v3_cross(P, u)));
        to->carried[i] = flow_energy(R, added, U);
    }
}

FL_SIMD_VERSIONS static void advance_half(fl_body_batch *restrict s, const half_drift *restrict to)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        advance_position(s, i, s->h[i]);
        fl_body_batch_set_vec(s->L, i, FL_BODY_BATCH_VEC(to->L, i));
    }
}

/* The other half, with R after the rotation. */
FL_SIMD_VERSIONS static void finish_water_drift(fl_body_batch *restrict s, fl_body_batch_water *restrict a,
                                                const half_drift *restrict to)
{
#pragma omp simd
    for (int32_t i = 0; i < s->lanes; i++) {
        const fl_rows3 R = fl_body_batch_axes(s, i);
        const fl_vec3 added = FL_BODY_BATCH_VEC(a->added_mass, i), U = FL_BODY_BATCH_VEC(a->flow_velocity, i),
                      P = FL_BODY_BATCH_VEC(to->P, i),
                      v = v3_add(U, fl_body_batch_velocity(R, s->m[i], added, P));
        a->flow_work[i] += flow_energy(R, added, U) - to->carried[i];
        fl_body_batch_set_vec(s->v, i, v);
        fl_body_batch_set_vec(s->L, i,
                              v3_madd(FL_BODY_BATCH_VEC(s->L, i), s->h[i], v3_cross(P, v3_sub(v, U))));
        advance_position(s, i, s->h[i]);
    }
}

static int drift_with_water(fl_body_batch *s, fl_body_batch_water *a)
{
    half_drift to;
    begin_water_drift(s, a, &to);
    const double most = 0.25 * (1.0 + ROUNDING_MARGIN) * max_turn2(s, to.L);
    if (!(most <= Q_HALF_ANGLE2_MAX)) return 0;
    advance_half(s, &to);
    if (most <= Q_HALF_ANGLE2_SMALL) turn_small(s);
    else turn_large(s);
    fl_body_batch_update_axes(s);
    finish_water_drift(s, a, &to);
    return 1;
}

int fl_body_batch_drift(fl_body_batch *s, fl_body_batch_water *a)
{
    if (a) return drift_with_water(s, a);
    const double most = 0.25 * (1.0 + ROUNDING_MARGIN) * max_turn2(s, s->L);
    if (!(most <= Q_HALF_ANGLE2_MAX)) return 0;
    if (most <= Q_HALF_ANGLE2_SMALL) drift_small(s);
    else drift_large(s);
    return 1;
}
