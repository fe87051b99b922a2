/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sym3.h -- symmetric 3 x 3 matrices, by value. */
#ifndef FL_GEOM_SYM3_H
#define FL_GEOM_SYM3_H
#include "base/simd.h"
#include "geom/mat3.h"

typedef struct {
    double xx, xy, xz, yy, yz, zz;
} fl_sym3;

FL_SIMD_INLINE fl_vec3 s3_mul(fl_sym3 K, fl_vec3 a)
{
    return v3(K.xx * a.x + K.xy * a.y + K.xz * a.z, K.xy * a.x + K.yy * a.y + K.yz * a.z,
              K.xz * a.x + K.yz * a.y + K.zz * a.z);
}

FL_SIMD_INLINE fl_sym3 s3_add(fl_sym3 a, fl_sym3 b)
{
    return (fl_sym3){a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}

/* s a */
FL_SIMD_INLINE fl_sym3 s3_times(double s, fl_sym3 a)
{
    return (fl_sym3){s * a.xx, s * a.xy, s * a.xz, s * a.yy, s * a.yz, s * a.zz};
}

/* d times the unit matrix. */
FL_SIMD_INLINE fl_sym3 s3_isotropic(double d) { return (fl_sym3){.xx = d, .yy = d, .zz = d}; }

/* x a^T + y b^T + z c^T, where the result is symmetric. */
FL_SIMD_INLINE fl_sym3 s3_products(fl_vec3 x, fl_vec3 y, fl_vec3 z, fl_vec3 a, fl_vec3 b, fl_vec3 c)
{
    return (fl_sym3){v3_dot(a, x), v3_dot(a, y), v3_dot(a, z), v3_dot(b, y), v3_dot(b, z), v3_dot(c, z)};
}

/* K given in a frame with axes x, y, z, transformed to the outer frame. */
FL_SIMD_INLINE fl_sym3 s3_rotated(fl_sym3 K, fl_vec3 x, fl_vec3 y, fl_vec3 z)
{
    const fl_vec3 a = v3_madd(v3_madd(v3_scale(K.xx, x), K.xy, y), K.xz, z),
                  b = v3_madd(v3_madd(v3_scale(K.xy, x), K.yy, y), K.yz, z),
                  c = v3_madd(v3_madd(v3_scale(K.xz, x), K.yz, y), K.zz, z);
    return (fl_sym3){a.x * x.x + b.x * y.x + c.x * z.x, a.x * x.y + b.x * y.y + c.x * z.y,
                     a.x * x.z + b.x * y.z + c.x * z.z, a.y * x.y + b.y * y.y + c.y * z.y,
                     a.y * x.z + b.y * y.z + c.y * z.z, a.z * x.z + b.z * y.z + c.z * z.z};
}

/* R diag(d) R^T */
static inline fl_sym3 s3_from_principal(const fl_mat3 *R, fl_vec3 d)
{
    const fl_vec3 x = v3(R->m[0][0], R->m[0][1], R->m[0][2]), y = v3(R->m[1][0], R->m[1][1], R->m[1][2]),
                  z = v3(R->m[2][0], R->m[2][1], R->m[2][2]);
    return s3_products(x, y, z, v3_mul(d, x), v3_mul(d, y), v3_mul(d, z));
}

#endif
