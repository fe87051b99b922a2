/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vec3.h -- vectors of three doubles, by value. */
#ifndef FL_GEOM_VEC3_H
#define FL_GEOM_VEC3_H
#include <math.h>

typedef struct {
    double x, y, z;
} fl_vec3;

static inline fl_vec3 v3(double x, double y, double z) { return (fl_vec3){x, y, z}; }
static inline fl_vec3 v3_add(fl_vec3 a, fl_vec3 b) { return v3(a.x + b.x, a.y + b.y, a.z + b.z); }
static inline fl_vec3 v3_sub(fl_vec3 a, fl_vec3 b) { return v3(a.x - b.x, a.y - b.y, a.z - b.z); }
static inline fl_vec3 v3_neg(fl_vec3 a) { return v3(-a.x, -a.y, -a.z); }
static inline fl_vec3 v3_scale(double s, fl_vec3 a) { return v3(s * a.x, s * a.y, s * a.z); }
/* a + s b */
static inline fl_vec3 v3_madd(fl_vec3 a, double s, fl_vec3 b)
{
    return v3(a.x + s * b.x, a.y + s * b.y, a.z + s * b.z);
}
static inline double v3_dot(fl_vec3 a, fl_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
static inline fl_vec3 v3_cross(fl_vec3 a, fl_vec3 b)
{
    return v3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
static inline double v3_norm2(fl_vec3 a) { return v3_dot(a, a); }
static inline double v3_norm(fl_vec3 a) { return sqrt(v3_dot(a, a)); }
/* a / |a|, or zero for a zero vector */
static inline fl_vec3 v3_unit(fl_vec3 a)
{
    const double n = v3_norm(a);
    return n > 0.0 ? v3_scale(1.0 / n, a) : v3(0, 0, 0);
}
static inline fl_vec3 v3_mul(fl_vec3 a, fl_vec3 b) { return v3(a.x * b.x, a.y * b.y, a.z * b.z); }
/* a + t (b - a) */
static inline fl_vec3 v3_lerp(fl_vec3 a, fl_vec3 b, double t) { return v3_madd(a, t, v3_sub(b, a)); }
static inline int v3_finite(fl_vec3 a) { return isfinite(a.x) && isfinite(a.y) && isfinite(a.z); }
/* True if a component is not zero. */
static inline int v3_nonzero(fl_vec3 a) { return a.x != 0.0 || a.y != 0.0 || a.z != 0.0; }
/* Component 0, 1 or 2. */
static inline double v3_at(fl_vec3 a, int k) { return k == 0 ? a.x : k == 1 ? a.y : a.z; }
/* A unit vector normal to the unit vector n, chosen by its smallest component. */
static inline fl_vec3 v3_normal_to(fl_vec3 n)
{
    const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
    const fl_vec3 e = x <= y && x <= z ? v3(1, 0, 0) : y <= z ? v3(0, 1, 0) : v3(0, 0, 1);
    return v3_unit(v3_cross(n, e));
}

#endif
