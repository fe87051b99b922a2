/* SPDX-License-Identifier: GPL-3.0-or-later */
/* simd3.h -- vectors in four lanes.  Macros, as in base/simd.h. */
#ifndef FL_GEOM_SIMD3_H
#define FL_GEOM_SIMD3_H
#include "base/simd.h"

typedef struct {
    fl_simd x, y, z;
} fl_simd3;

/* From three rows of FL_SIMD_WIDTH doubles, and into them. */
#define FL_SIMD3_LOAD(a) ((fl_simd3){FL_SIMD_LOAD((a)[0]), FL_SIMD_LOAD((a)[1]), FL_SIMD_LOAD((a)[2])})
#define FL_SIMD3_STORE(a, p)                                                                                 \
    (FL_SIMD_STORE((a)[0]) = (p).x, FL_SIMD_STORE((a)[1]) = (p).y, FL_SIMD_STORE((a)[2]) = (p).z)

/* a - b;  a + s b;  s a;  a.b */
#define FL_SIMD3_SUB(a, b) ((fl_simd3){(a).x - (b).x, (a).y - (b).y, (a).z - (b).z})
#define FL_SIMD3_MADD(a, s, b) ((fl_simd3){(a).x + (s) * (b).x, (a).y + (s) * (b).y, (a).z + (s) * (b).z})
#define FL_SIMD3_SCALE(s, a) ((fl_simd3){(s) * (a).x, (s) * (a).y, (s) * (a).z})
#define FL_SIMD3_DOT(a, b) ((a).x * (b).x + (a).y * (b).y + (a).z * (b).z)

#endif
