/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region_cover.h -- whether a flat sheet is one convex polygon, however it is triangulated.
 *
 * A sheet that is one convex polygon is two-sided, and usually its rim shows that it is one. There is no such
 * rim if vertices lie on sides of other triangles, or if triangles are repeated, face both ways or have no
 * area. Then the area decides: that of the convex hull. */
#ifndef FL_STRUCTURE_REGION_COVER_H
#define FL_STRUCTURE_REGION_COVER_H
#include "geom/surface.h"

/* True if all triangles of p lie in the plane n.x = c, within tol [m], facing either way; of a triangle
 * without area the corners count. */
int fl_region_is_flat(const fl_part *p, fl_vec3 n, double c, double tol);

/* Returns 1 if such triangles cover their convex hull once on each side that they have, within tol times its
 * outline; else 0.
 *   loop   [p->nv] out: vertices of the hull, counter-clockwise about n
 *   count  out: their number
 * Returns -1 with FL_SYSTEM. */
int fl_region_covers_hull(const fl_part *p, fl_vec3 n, double tol, int32_t *loop, int32_t *count,
                          fl_err *err);

#endif
