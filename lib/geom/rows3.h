/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rows3.h -- 3 x 3 matrices by their rows, for loops over lanes, where arrays by value are slow. */
#ifndef FL_GEOM_ROWS3_H
#define FL_GEOM_ROWS3_H
#include "base/simd.h"
#include "geom/mat3.h"

typedef struct {
    fl_vec3 x, y, z;
} fl_rows3;

static inline fl_rows3 r3_of(fl_mat3 a)
{
    return (fl_rows3){v3(a.m[0][0], a.m[0][1], a.m[0][2]), v3(a.m[1][0], a.m[1][1], a.m[1][2]),
                      v3(a.m[2][0], a.m[2][1], a.m[2][2])};
}

/* R a;  transpose(R) a */
FL_SIMD_INLINE fl_vec3 r3_mul(fl_rows3 R, fl_vec3 a)
{
    return v3(v3_dot(R.x, a), v3_dot(R.y, a), v3_dot(R.z, a));
}

FL_SIMD_INLINE fl_vec3 r3_tmul(fl_rows3 R, fl_vec3 a)
{
    return v3(R.x.x * a.x + R.y.x * a.y + R.z.x * a.z, R.x.y * a.x + R.y.y * a.y + R.z.y * a.z,
              R.x.z * a.x + R.y.z * a.y + R.z.z * a.z);
}

#endif
