/* SPDX-License-Identifier: GPL-3.0-or-later */
/* waterplane_cut.h -- the plan view of the part of a structure between two levels, as a hole in the water. */
#ifndef FL_ICE_WATERPLANE_CUT_H
#define FL_ICE_WATERPLANE_CUT_H
#include "geom/surface.h"
#include "ice/domain.h"

/* Range of the number of sides of a polygon round a part. */
enum { FL_WATERPLANE_MAX_SIDES = 64, FL_WATERPLANE_MIN_SIDES = 4 };

/* Add holes to the domain for the part of s between the levels z0 < z1, one for each group of triangles that
 * are connected by vertices, and for each cone.  A closed group has its outline in plan, see plan_outline.h.
 * Around cones and other groups stands a convex polygon, whose sides have the normals 2 pi k / K, each as far
 * out as the farthest point of the group in that direction plus `margin` [m].  K is the least power of two,
 * from 4 to 64, for which such a polygon round a circle of the size of the group is at most `coarse` [m] away
 * from the circle,
 *    R (1 / cos(pi / K) - 1) <= coarse,   R: half the diagonal of the box of the group,
 * so that the sides of ice floes next to it are not cut much shorter than floes are.
 *    *kept  out: number of groups between the levels
 * Returns 0, or -1 with FL_SYSTEM or FL_INPUT (a group without area and a margin of 0). */
int fl_waterplane_keep_out(fl_domain *d, const fl_surface *s, double z0, double z1, double margin,
                           double coarse, int32_t *kept, fl_err *err);

#endif
