/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region_cover.h -- a flat sheet by what it covers, however it is triangulated.
 *
 * A sheet that is one convex polygon is felt from both sides, and its rim tells that it is one.  Where
 * vertices hang on sides of other triangles, or a triangle comes twice, or from both sides, or has no area,
 * there is no such rim, though the sheet is the same.  So it is told by its area: that of the convex hull. */
#ifndef FL_STRUCTURE_REGION_COVER_H
#define FL_STRUCTURE_REGION_COVER_H
#include "geom/surface.h"

/* Whether all triangles of p lie in the plane n.x = c, within tol [m], facing either way.  Of those without
 * area the corners alone. */
int fl_region_is_flat(const fl_part *p, fl_vec3 n, double c, double tol);

/* 1 where triangles that lie so cover their convex hull, once on each side they have, but for tol times its
 * outline; else 0.
 *   loop   [p->nv] out: vertices of the hull, counter-clockwise about n
 *   count  out: how many
 * -1 with FL_SYSTEM. */
int fl_region_covers_hull(const fl_part *p, fl_vec3 n, double tol, int32_t *loop, int32_t *count,
                          fl_err *err);

#endif
