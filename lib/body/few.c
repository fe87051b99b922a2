/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "body/few.h"

FL_FOUR_VERSIONS void fl_few_take(fl_few *s, const fl_bodies *b, int32_t from, int32_t n)
{
    const size_t some = (size_t)n * sizeof(double);
    s->from = from;
    s->n = n;
    memcpy(s->m, b->m + from, some);
    memcpy(s->invm, b->invm + from, some);
    fl_few_split(s->I, b->I + from, n);
    fl_few_split(s->v, b->v + from, n);
    fl_few_split(s->L, b->L + from, n);
    fl_few_split(s->w, b->w + from, n);
    fl_few_split4(s->R, &b->R[from].m[0][0], sizeof *b->R, n);
    fl_few_split4(s->R + 4, &b->R[from].m[1][1], sizeof *b->R, n);
    for (int32_t k = 0; k < n; k++) s->R[8][k] = b->R[from + k].m[2][2];
}

FL_FOUR_VERSIONS void fl_few_take_forces(fl_few *s, const fl_bodies *b)
{
    fl_few_split(s->f, b->f + s->from, s->n);
    fl_few_split(s->t, b->t + s->from, s->n);
}

FL_FOUR_VERSIONS void fl_few_take_pose(fl_few *s, const fl_bodies *b)
{
    const size_t some = (size_t)s->n * sizeof(double);
    fl_few_split(s->x, b->x + s->from, s->n);
    fl_few_split4(s->q, b->q + s->from, sizeof *b->q, s->n);
    memcpy(s->odometer, b->odometer + s->from, some);
    memcpy(s->bound, b->bound + s->from, some);
}

FL_FOUR_VERSIONS void fl_few_put_forces(const fl_few *s, fl_bodies *b)
{
    fl_few_join(b->f + s->from, s->f, s->n);
    fl_few_join(b->t + s->from, s->t, s->n);
}

FL_FOUR_VERSIONS void fl_few_put_speeds(const fl_few *s, fl_bodies *b)
{
    fl_few_join(b->v + s->from, s->v, s->n);
    fl_few_join(b->L + s->from, s->L, s->n);
    fl_few_join(b->w + s->from, s->w, s->n);
}

FL_FOUR_VERSIONS void fl_few_put_pose(const fl_few *s, fl_bodies *b)
{
    fl_mat3 *R = b->R + s->from;
    fl_few_join(b->x + s->from, s->x, s->n);
    fl_few_join4(b->q + s->from, sizeof *b->q, s->q, s->n);
    fl_few_join4(&R->m[0][0], sizeof *R, s->R, s->n);
    fl_few_join4(&R->m[1][1], sizeof *R, s->R + 4, s->n);
    for (int32_t k = 0; k < s->n; k++) R[k].m[2][2] = s->R[8][k];
    memcpy(b->odometer + s->from, s->odometer, (size_t)s->n * sizeof(double));
}

FL_WIDE_VERSIONS void fl_few_weigh(fl_few *s, fl_vec3 gravity)
{
    const double g[3] = {gravity.x, gravity.y, gravity.z};
    for (int c = 0; c < 3; c++) {
#pragma omp simd
        for (int32_t i = 0; i < s->n; i++) {
            s->f[c][i] = s->m[i] * g[c];
            s->t[c][i] = 0.0;
        }
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
        const double xx = qx * qx, yy = qy * qy, zz = qz * qz, xy = qx * qy, xz = qx * qz, yz = qy * qz,
                     wx = qw * qx, wy = qw * qy, wz = qw * qz;
        const double m00 = 1 - 2 * (yy + zz), m01 = 2 * (xy - wz), m02 = 2 * (xz + wy), m10 = 2 * (xy + wz),
                     m11 = 1 - 2 * (xx + zz), m12 = 2 * (yz - wx), m20 = 2 * (xz - wy), m21 = 2 * (yz + wx),
                     m22 = 1 - 2 * (xx + yy);
        s->R[0][i] = m00;
        s->R[1][i] = m01;
        s->R[2][i] = m02;
        s->R[3][i] = m10;
        s->R[4][i] = m11;
        s->R[5][i] = m12;
        s->R[6][i] = m20;
        s->R[7][i] = m21;
        s->R[8][i] = m22;
        const double u0 = (m00 * Lx + m10 * Ly + m20 * Lz) / I0, u1 = (m01 * Lx + m11 * Ly + m21 * Lz) / I1,
                     u2 = (m02 * Lx + m12 * Ly + m22 * Lz) / I2;
        s->w[0][i] = m00 * u0 + m01 * u1 + m02 * u2;
        s->w[1][i] = m10 * u0 + m11 * u1 + m12 * u2;
        s->w[2][i] = m20 * u0 + m21 * u1 + m22 * u2;
    }
}

int fl_few_drift(fl_few *s, double dt)
{
    if (wild(s, dt) > 0.0) return 0;
    drift(s, dt);
    return 1;
}
