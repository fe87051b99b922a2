/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "body/few.h"

/* What is left behind the last four goes one by one. */
static void split_one(double (*to)[FL_FEW], fl_vec3 a, int32_t k)
{
    to[0][k] = a.x, to[1][k] = a.y, to[2][k] = a.z;
}

static fl_vec3 join_one(const double (*from)[FL_FEW], int32_t k)
{
    return v3(from[0][k], from[1][k], from[2][k]);
}

/* q_matrix() */
FL_WIDE_VERSIONS static void find_axes(fl_few *restrict s)
{
#pragma omp simd
    for (int32_t i = 0; i < s->n; i++) {
        const double w = s->q[0][i], x = s->q[1][i], y = s->q[2][i], z = s->q[3][i];
        const double xx = x * x, yy = y * y, zz = z * z, xy = x * y, xz = x * z, yz = y * z, wx = w * x,
                     wy = w * y, wz = w * z;
        s->R[0][i] = 1 - 2 * (yy + zz), s->R[1][i] = 2 * (xy - wz), s->R[2][i] = 2 * (xz + wy);
        s->R[3][i] = 2 * (xy + wz), s->R[4][i] = 1 - 2 * (xx + zz), s->R[5][i] = 2 * (yz - wx);
        s->R[6][i] = 2 * (xz - wy), s->R[7][i] = 2 * (yz + wx), s->R[8][i] = 1 - 2 * (xx + yy);
    }
}

FL_FOUR_VERSIONS static void take(fl_few *s, const fl_bodies *b, int32_t from, int32_t n)
{
    const double *m = b->m + from, *invm = b->invm + from;
    const fl_vec3 *I = b->I + from, *v = b->v + from, *L = b->L + from, *w = b->w + from;
    const fl_quat *q = b->q + from;
    int32_t k = 0;
    s->from = from;
    s->n = n;
    for (; k + FL_LANES <= n; k += FL_LANES) {
        FL_FOUR_INTO(&s->m[k]) = FL_FOUR(&m[k]);
        FL_FOUR_INTO(&s->invm[k]) = FL_FOUR(&invm[k]);
        fl_few_split(s->I, I, k);
        fl_few_split(s->v, v, k);
        fl_few_split(s->L, L, k);
        fl_few_split(s->w, w, k);
        fl_few_split4(s->q, q, sizeof *q, k);
    }
    for (; k < n; k++) {
        s->m[k] = m[k], s->invm[k] = invm[k];
        split_one(s->I, I[k], k), split_one(s->v, v[k], k);
        split_one(s->L, L[k], k), split_one(s->w, w[k], k);
        s->q[0][k] = q[k].w, s->q[1][k] = q[k].x, s->q[2][k] = q[k].y, s->q[3][k] = q[k].z;
    }
}

void fl_few_take(fl_few *s, const fl_bodies *b, int32_t from, int32_t n)
{
    take(s, b, from, n);
    find_axes(s);
}

FL_FOUR_VERSIONS void fl_few_take_forces(fl_few *s, const fl_bodies *b)
{
    const fl_vec3 *f = b->f + s->from, *t = b->t + s->from;
    int32_t k = 0;
    for (; k + FL_LANES <= s->n; k += FL_LANES) {
        fl_few_split(s->f, f, k);
        fl_few_split(s->t, t, k);
    }
    for (; k < s->n; k++) split_one(s->f, f[k], k), split_one(s->t, t[k], k);
}

FL_FOUR_VERSIONS void fl_few_take_pose(fl_few *s, const fl_bodies *b)
{
    const fl_vec3 *x = b->x + s->from;
    const double *odometer = b->odometer + s->from, *bound = b->bound + s->from;
    int32_t k = 0;
    for (; k + FL_LANES <= s->n; k += FL_LANES) {
        fl_few_split(s->x, x, k);
        FL_FOUR_INTO(&s->odometer[k]) = FL_FOUR(&odometer[k]);
        FL_FOUR_INTO(&s->bound[k]) = FL_FOUR(&bound[k]);
    }
    for (; k < s->n; k++) {
        split_one(s->x, x[k], k);
        s->odometer[k] = odometer[k], s->bound[k] = bound[k];
    }
}

FL_FOUR_VERSIONS void fl_few_put_forces(const fl_few *s, fl_bodies *b)
{
    fl_vec3 *f = b->f + s->from, *t = b->t + s->from;
    int32_t k = 0;
    for (; k + FL_LANES <= s->n; k += FL_LANES) {
        fl_few_join(f, s->f, k);
        fl_few_join(t, s->t, k);
    }
    for (; k < s->n; k++) f[k] = join_one(s->f, k), t[k] = join_one(s->t, k);
}

FL_FOUR_VERSIONS void fl_few_put_speeds(const fl_few *s, fl_bodies *b)
{
    fl_vec3 *v = b->v + s->from, *L = b->L + s->from, *w = b->w + s->from;
    int32_t k = 0;
    for (; k + FL_LANES <= s->n; k += FL_LANES) {
        fl_few_join(v, s->v, k);
        fl_few_join(L, s->L, k);
        fl_few_join(w, s->w, k);
    }
    for (; k < s->n; k++) v[k] = join_one(s->v, k), L[k] = join_one(s->L, k), w[k] = join_one(s->w, k);
}

FL_FOUR_VERSIONS void fl_few_put_pose(const fl_few *s, fl_bodies *b)
{
    fl_vec3 *x = b->x + s->from;
    fl_quat *q = b->q + s->from;
    double *odometer = b->odometer + s->from;
    int32_t k = 0;
    for (; k + FL_LANES <= s->n; k += FL_LANES) {
        fl_few_join(x, s->x, k);
        fl_few_join4(q, sizeof *q, s->q, k);
        FL_FOUR_INTO(&odometer[k]) = FL_FOUR(&s->odometer[k]);
    }
    for (; k < s->n; k++) {
        x[k] = join_one(s->x, k);
        q[k] = (fl_quat){s->q[0][k], s->q[1][k], s->q[2][k], s->q[3][k]};
        odometer[k] = s->odometer[k];
    }
}

FL_WIDE_VERSIONS void fl_few_weigh(fl_few *restrict s, fl_vec3 gravity)
{
#pragma omp simd
    for (int32_t i = 0; i < s->n; i++) {
        s->f[0][i] = s->m[i] * gravity.x;
        s->f[1][i] = s->m[i] * gravity.y;
        s->f[2][i] = s->m[i] * gravity.z;
        s->t[0][i] = 0.0;
        s->t[1][i] = 0.0;
        s->t[2][i] = 0.0;
    }
}

FL_WIDE_VERSIONS void fl_few_kick(fl_few *restrict s, double h)
{
#pragma omp simd
    for (int32_t i = 0; i < s->n; i++) {
        const double by = h * s->invm[i];
        const double ux = s->v[0][i] + by * s->f[0][i], uy = s->v[1][i] + by * s->f[1][i],
                     uz = s->v[2][i] + by * s->f[2][i];
        s->dv[0][i] = ux - s->v[0][i];
        s->dv[1][i] = uy - s->v[1][i];
        s->dv[2][i] = uz - s->v[2][i];
        s->v[0][i] = ux;
        s->v[1][i] = uy;
        s->v[2][i] = uz;
        const double x = s->L[0][i] + h * s->t[0][i], y = s->L[1][i] + h * s->t[1][i],
                     z = s->L[2][i] + h * s->t[2][i];
        s->L[0][i] = x;
        s->L[1][i] = y;
        s->L[2][i] = z;
        const double a = (s->R[0][i] * x + s->R[3][i] * y + s->R[6][i] * z) / s->I[0][i],
                     b = (s->R[1][i] * x + s->R[4][i] * y + s->R[7][i] * z) / s->I[1][i],
                     c = (s->R[2][i] * x + s->R[5][i] * y + s->R[8][i] * z) / s->I[2][i];
        const double wx = s->R[0][i] * a + s->R[1][i] * b + s->R[2][i] * c,
                     wy = s->R[3][i] * a + s->R[4][i] * b + s->R[5][i] * c,
                     wz = s->R[6][i] * a + s->R[7][i] * b + s->R[8][i] * c;
        s->dw[0][i] = wx - s->w[0][i];
        s->dw[1][i] = wy - s->w[1][i];
        s->dw[2][i] = wz - s->w[2][i];
        s->w[0][i] = wx;
        s->w[1][i] = wy;
        s->w[2][i] = wz;
    }
}

/* How many turn in dt by more than the series is for: below half a radian it needs no halving, as in all but
 * the wildest steps. */
FL_WIDE_VERSIONS static double wild(const fl_few *restrict s, double dt)
{
    double many = 0.0;
#pragma omp simd reduction(+ : many)
    for (int32_t i = 0; i < s->n; i++) {
        const double x = dt * s->L[0][i], y = dt * s->L[1][i], z = dt * s->L[2][i], I = s->I[0][i];
        many += x * x + y * y + z * z > 0.99 * 4.0 * Q_HALF_TURN_MOST * (I * I) ? 1.0 : 0.0;
    }
    return many;
}

/* fl_drift() with fl_drift_rotation() and its three turns written out. */
FL_WIDE_VERSIONS static void drift(fl_few *restrict s, double dt)
{
    const double path = fabs(dt);
#pragma omp simd
    for (int32_t i = 0; i < s->n; i++) {
        const double vx = s->v[0][i], vy = s->v[1][i], vz = s->v[2][i];
        s->x[0][i] += dt * vx;
        s->x[1][i] += dt * vy;
        s->x[2][i] += dt * vz;
        const double gone = s->odometer[i] + path * sqrt(vx * vx + vy * vy + vz * vz);
        const double Lx = s->L[0][i], Ly = s->L[1][i], Lz = s->L[2][i];
        const double I0 = s->I[0][i], I1 = s->I[1][i], I2 = s->I[2][i];
        const double a0 = 0.5 * dt * (1.0 / I0 - 1.0 / I1), a2 = dt * (1.0 / I2 - 1.0 / I1);
        const double ow = s->q[0][i], ox = s->q[1][i], oy = s->q[2][i], oz = s->q[3][i];
        /* about its first axis */
        const double l0 =
            (1 - 2 * (oy * oy + oz * oz)) * Lx + 2 * (ox * oy + ow * oz) * Ly + 2 * (ox * oz - ow * oy) * Lz;
        const double r0 = a0 * l0, v0 = 0.25 * r0 * r0;
        const double c0 = 1.0 - q_versine(v0), s0 = q_sinc(v0) * (0.5 * r0);
        const double aw = ow * c0 - ox * s0, ax = ow * s0 + ox * c0, ay = oy * c0 + oz * s0,
                     az = oz * c0 - oy * s0;
        /* as a symmetric top: about its third axis, then about L */
        const double l2 =
            2 * (ax * az + aw * ay) * Lx + 2 * (ay * az - aw * ax) * Ly + (1 - 2 * (ax * ax + ay * ay)) * Lz;
        const double r2 = a2 * l2, v2 = 0.25 * r2 * r2;
        const double c2 = 1.0 - q_versine(v2), s2 = q_sinc(v2) * (0.5 * r2);
        const double bw = aw * c2 - az * s2, bx = ax * c2 + ay * s2, by = ay * c2 - ax * s2,
                     bz = az * c2 + aw * s2;
        const double k = dt / I1, rx = k * Lx, ry = k * Ly, rz = k * Lz;
        const double v1 = 0.25 * (rx * rx + ry * ry + rz * rz);
        const double c1 = 1.0 - q_versine(v1), s1 = 0.5 * q_sinc(v1);
        const double hx = s1 * rx, hy = s1 * ry, hz = s1 * rz;
        const double dw = c1 * bw - hx * bx - hy * by - hz * bz, dx = c1 * bx + hx * bw + hy * bz - hz * by,
                     dy = c1 * by - hx * bz + hy * bw + hz * bx, dz = c1 * bz + hx * by - hy * bx + hz * bw;
        /* and about the first axis again */
        const double l3 =
            (1 - 2 * (dy * dy + dz * dz)) * Lx + 2 * (dx * dy + dw * dz) * Ly + 2 * (dx * dz - dw * dy) * Lz;
        const double r3 = a0 * l3, v3fold = 0.25 * r3 * r3;
        const double c3 = 1.0 - q_versine(v3fold), s3 = q_sinc(v3fold) * (0.5 * r3);
        const double ew = dw * c3 - dx * s3, ex = dw * s3 + dx * c3, ey = dy * c3 + dz * s3,
                     ez = dz * c3 - dy * s3;
        const double one = 1.5 - 0.5 * (ew * ew + ex * ex + ey * ey + ez * ez);
        /* one without momentum stays as it is, to the bit */
        const int turns = fabs(Lx) + fabs(Ly) + fabs(Lz) > 0.0;
        const double qw = turns ? one * ew : ow, qx = turns ? one * ex : ox, qy = turns ? one * ey : oy,
                     qz = turns ? one * ez : oz;
        s->q[0][i] = qw;
        s->q[1][i] = qx;
        s->q[2][i] = qy;
        s->q[3][i] = qz;
        /* the vector part of q conj(old) */
        const double fx = qx * ow - qw * ox - qy * oz + qz * oy, fy = qy * ow - qw * oy + qx * oz - qz * ox,
                     fz = qz * ow - qw * oz - qx * oy + qy * ox;
        s->odometer[i] = gone + 2.0 * sqrt(fx * fx + fy * fy + fz * fz) * s->bound[i];
    }
}

/* fl_body_turn() of L */
FL_WIDE_VERSIONS static void find_spins(fl_few *restrict s)
{
#pragma omp simd
    for (int32_t i = 0; i < s->n; i++) {
        const double x = s->L[0][i], y = s->L[1][i], z = s->L[2][i];
        const double a = (s->R[0][i] * x + s->R[3][i] * y + s->R[6][i] * z) / s->I[0][i],
                     b = (s->R[1][i] * x + s->R[4][i] * y + s->R[7][i] * z) / s->I[1][i],
                     c = (s->R[2][i] * x + s->R[5][i] * y + s->R[8][i] * z) / s->I[2][i];
        s->w[0][i] = s->R[0][i] * a + s->R[1][i] * b + s->R[2][i] * c;
        s->w[1][i] = s->R[3][i] * a + s->R[4][i] * b + s->R[5][i] * c;
        s->w[2][i] = s->R[6][i] * a + s->R[7][i] * b + s->R[8][i] * c;
    }
}

int fl_few_drift(fl_few *s, double dt)
{
    if (wild(s, dt) > 0.0) return 0;
    drift(s, dt);
    find_axes(s);
    find_spins(s);
    return 1;
}
