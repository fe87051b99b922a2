/* SPDX-License-Identifier: GPL-3.0-or-later */
/* aabb.h -- axis-aligned bounding boxes, by value.  The empty box has lo > hi. */
#ifndef FL_GEOM_AABB_H
#define FL_GEOM_AABB_H
#include "geom/vec3.h"

typedef struct {
    fl_vec3 lo, hi;
} fl_aabb;

static inline fl_aabb aabb_empty(void)
{
    return (fl_aabb){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
}
static inline fl_aabb aabb_add(fl_aabb b, fl_vec3 p)
{
    return (fl_aabb){{p.x < b.lo.x ? p.x : b.lo.x, p.y < b.lo.y ? p.y : b.lo.y, p.z < b.lo.z ? p.z : b.lo.z},
                     {p.x > b.hi.x ? p.x : b.hi.x, p.y > b.hi.y ? p.y : b.hi.y, p.z > b.hi.z ? p.z : b.hi.z}};
}
static inline fl_aabb aabb_join(fl_aabb a, fl_aabb b) { return aabb_add(aabb_add(a, b.lo), b.hi); }
static inline fl_aabb aabb_grow(fl_aabb b, double r)
{
    return (fl_aabb){{b.lo.x - r, b.lo.y - r, b.lo.z - r}, {b.hi.x + r, b.hi.y + r, b.hi.z + r}};
}
static inline int aabb_overlap(fl_aabb a, fl_aabb b)
{
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y && a.lo.z <= b.hi.z &&
           b.lo.z <= a.hi.z;
}
/* Squared distance of a point; 0 inside. */
static inline double aabb_distance2(fl_aabb b, fl_vec3 x)
{
    const double ax = b.lo.x - x.x, bx = x.x - b.hi.x, ay = b.lo.y - x.y, by = x.y - b.hi.y,
                 az = b.lo.z - x.z, bz = x.z - b.hi.z;
    const double dx = ax > 0.0   ? ax
                      : bx > 0.0 ? bx
                                 : 0.0,
                 dy = ay > 0.0   ? ay
                      : by > 0.0 ? by
                                 : 0.0,
                 dz = az > 0.0   ? az
                      : bz > 0.0 ? bz
                                 : 0.0;
    return dx * dx + dy * dy + dz * dz;
}

#endif
