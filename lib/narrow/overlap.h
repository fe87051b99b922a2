/* SPDX-License-Identifier: GPL-3.0-or-later */
/* overlap.h -- intersection of two flat features projected along a direction: area, length, centroid. */
#ifndef FL_NARROW_OVERLAP_H
#define FL_NARROW_OVERLAP_H
#include <stdint.h>
#include "geom/vec3.h"

/* Two axes across a direction; the third coordinate of a point is dropped. */
typedef struct {
    fl_vec3 o, x, y; /* origin [m]; orthonormal */
} fl_plane_axes;

/* A convex polygon: the points v[loop[0 .. n)] in order, either orientation. */
typedef struct {
    const fl_vec3 *v;
    const int32_t *loop;
    int32_t n;
} fl_loop;

typedef struct {
    double size; /* area [m2] or length [m], 0 for an empty intersection */
    double x, y; /* centroid in the axes, undefined when size is 0 [m]   */
} fl_projected_overlap;

/* Axes across the unit vector n with origin o. */
fl_plane_axes fl_plane_axes_of(fl_vec3 o, fl_vec3 n);

/* Area and centroid of the intersection of two convex polygons, projected along the third axis,
 *     A = int max(0, min(ua, ub) - max(la, lb)) dx,
 * u and l the upper and lower outlines.  These are broken lines, so the integral is an exact sum over the
 * strips between all corners and crossings.  No case is decided by a sign: the area is a continuous function
 * of the corners, even where edges or corners coincide.  Error: a few 2^-53 of the squared extent.  Allocates
 * nothing. */
fl_projected_overlap fl_overlap_area(const fl_plane_axes *t, fl_loop a, fl_loop b);

/* Length and midpoint of the part of the segment p q inside a convex polygon, projected along the third axis.
 * A segment within tol [m] of the border is inside. */
fl_projected_overlap fl_overlap_length(const fl_plane_axes *t, fl_vec3 p, fl_vec3 q, fl_loop a, double tol);

#endif
