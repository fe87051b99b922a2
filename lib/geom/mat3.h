/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mat3.h -- 3 x 3 matrices, by value, in row order. */
#ifndef FL_GEOM_MAT3_H
#define FL_GEOM_MAT3_H
#include "geom/vec3.h"

typedef struct {
    double m[3][3];
} fl_mat3;

static inline fl_vec3 m3_mul(fl_mat3 a, fl_vec3 v)
{
    return v3(a.m[0][0] * v.x + a.m[0][1] * v.y + a.m[0][2] * v.z,
              a.m[1][0] * v.x + a.m[1][1] * v.y + a.m[1][2] * v.z,
              a.m[2][0] * v.x + a.m[2][1] * v.y + a.m[2][2] * v.z);
}
/* transpose(a) v */
static inline fl_vec3 m3_tmul(fl_mat3 a, fl_vec3 v)
{
    return v3(a.m[0][0] * v.x + a.m[1][0] * v.y + a.m[2][0] * v.z,
              a.m[0][1] * v.x + a.m[1][1] * v.y + a.m[2][1] * v.z,
              a.m[0][2] * v.x + a.m[1][2] * v.y + a.m[2][2] * v.z);
}
static inline fl_vec3 m3_col(fl_mat3 a, int k) { return v3(a.m[0][k], a.m[1][k], a.m[2][k]); }

#endif
