/* SPDX-License-Identifier: GPL-3.0-or-later */
/* waterplane_cut.h -- the water that a structure takes up: the plan view of what of it lies between two levels. */
#ifndef FL_ICE_WATERPLANE_CUT_H
#define FL_ICE_WATERPLANE_CUT_H
#include "geom/surface.h"
#include "ice/domain.h"

/* The most and the fewest sides of a polygon round a section. */
enum { FL_WATERPLANE_MAX_SIDES = 64, FL_WATERPLANE_MIN_SIDES = 4 };

/* Keep out of the domain what s has between the levels z0 < z1: round each group of triangles that hang
 * together by their vertices, and round each cone, a polygon is laid whose sides have the directions
 * 2 pi k / K, each as far out as the farthest point of the group in that direction, and `margin` [m] more.
 * It is convex, and holds the group with the margin.  K is the least power of two, from 4 to 64, for which
 * such a polygon round a circle of the group's size stands off from it by no more than `coarse` [m]:
 *     R (1 / cos(pi / K) - 1) <= coarse,   R half the diagonal of the group's box
 * so that ice floes beside it are not cut by sides much shorter than they are.
 *   *kept  out: how many groups reach into the levels
 * Returns 0, or -1 with FL_SYSTEM, or with FL_INPUT (a group with no area, and a margin of 0). */
int fl_waterplane_keep_out(fl_domain *d, const fl_surface *s, double z0, double z1, double margin,
                           double coarse, int32_t *kept, fl_err *err);

#endif
