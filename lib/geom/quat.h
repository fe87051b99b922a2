/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quat.h -- unit quaternions (w, x, y, z) for the rotation from body axes to world axes, by value. */
#ifndef FL_GEOM_QUAT_H
#define FL_GEOM_QUAT_H
#include "geom/mat3.h"

typedef struct {
    double w, x, y, z;
} fl_quat;

static inline fl_quat q_one(void) { return (fl_quat){1, 0, 0, 0}; }
static inline fl_quat q_mul(fl_quat a, fl_quat b)
{
    return (fl_quat){
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
static inline fl_quat q_conj(fl_quat q) { return (fl_quat){q.w, -q.x, -q.y, -q.z}; }
static inline fl_quat q_unit(fl_quat q)
{
    const double s = 1.0 / sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    return (fl_quat){s * q.w, s * q.x, s * q.y, s * q.z};
}
/* The rotation matrix of q: its columns are the body axes in the world. */
static inline fl_mat3 q_matrix(fl_quat q)
{
    const double xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z,
                 yz = q.y * q.z, wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return (fl_mat3){{{1 - 2 * (yy + zz), 2 * (xy - wz), 2 * (xz + wy)},
                      {2 * (xy + wz), 1 - 2 * (xx + zz), 2 * (yz - wx)},
                      {2 * (xz - wy), 2 * (yz + wx), 1 - 2 * (xx + yy)}}};
}
static inline fl_vec3 q_rotate(fl_quat q, fl_vec3 v) { return m3_mul(q_matrix(q), v); }

/* The quaternion of the rotation matrix a.  Source: Shepperd's choice of the largest element. */
fl_quat q_of_matrix(fl_mat3 a);

/* 1 - cos x, without cancellation, and sin(x)/x, from x^2.  The first omitted term of these series is below
 * 1e-18 for x^2 up to Q_HALF_ANGLE2_SMALL, which nearly all steps satisfy, */
#define Q_HALF_ANGLE2_SMALL 4e-4
static inline double q_versine_small(double x2)
{
    return x2 * (1.0 / 2 - x2 * (1.0 / 24 - x2 * (1.0 / 720)));
}
static inline double q_sinc_small(double x2)
{
    return 1.0 - x2 * (1.0 / 6 - x2 * (1.0 / 120 - x2 * (1.0 / 5040)));
}
/* and below 1e-17 up to Q_HALF_ANGLE2_MAX. */
#define Q_HALF_ANGLE2_MAX 0.0625
static inline double q_versine(double x2)
{
    if (x2 <= Q_HALF_ANGLE2_SMALL) return q_versine_small(x2);
    double v = 1.0 / 479001600 - x2 * (1.0 / 87178291200.0);
    v = 1.0 / 3628800 - x2 * v;
    v = 1.0 / 40320 - x2 * v;
    v = 1.0 / 720 - x2 * v;
    v = 1.0 / 24 - x2 * v;
    return x2 * (1.0 / 2 - x2 * v);
}
static inline double q_sinc(double x2)
{
    if (x2 <= Q_HALF_ANGLE2_SMALL) return q_sinc_small(x2);
    double f = 1.0 / 39916800 - x2 * (1.0 / 6227020800.0);
    f = 1.0 / 362880 - x2 * f;
    f = 1.0 / 5040 - x2 * f;
    f = 1.0 / 120 - x2 * f;
    f = 1.0 / 6 - x2 * f;
    return 1.0 - x2 * f;
}

/* cos x and sin(x)/x from x^2, for any x.  The argument is halved until |x| <= 1/4 and doubled back by 1 -
 * cos 2x = 2 (1 - cos x) (1 + cos x), sinc 2x = sinc x cos x.  A step turns a body by far less than half a
 * radian, so the loop is rarely entered. */
static inline void q_cos_sinc(double x2, double *c, double *s)
{
    int twice = 0;
    while (x2 > Q_HALF_ANGLE2_MAX && twice < 60) {
        x2 *= 0.25;
        twice++;
    }
    double v = q_versine(x2), f = q_sinc(x2);
    for (; twice > 0; twice--) {
        f *= 1.0 - v;
        v = 2.0 * v * (2.0 - v);
    }
    *c = 1.0 - v;
    *s = f;
}

/* Rotation by |r| about r, r in rad.  Half-angle sine and cosine come from a fixed polynomial (quat.c), so
 * the bits do not depend on the C library.  Error below 2e-16 for |r| <= 1/2, growing slowly beyond (2e-15 at
 * 10 rad). */
fl_quat q_of_vector(fl_vec3 r);
/* Same about body axis k = 0, 1, 2 by angle a [rad], at half the cost. */
fl_quat q_about_axis(int k, double a);

#endif
