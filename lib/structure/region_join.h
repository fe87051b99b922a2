/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region_join.h -- joins polygons in space to one triangulated surface.
 *
 * Corners within tol of each other become one, and a corner on the side of a polygon becomes a corner of
 * it. About an edge where several sheets meet, sorted by angle, the facing sides of two neighbours bound
 * the same space: they are joined.  A two-sided polygon has a front and a back, joined along its rim, so
 * that a plate is a thin closed shell, whatever stands on it.  Corners are one vertex where the sides
 * round them are joined, so that shells that meet in an edge or a corner stay apart. */
#ifndef FL_STRUCTURE_REGION_JOIN_H
#define FL_STRUCTURE_REGION_JOIN_H
#include "structure/region_cut.h"

/* Makes the triangles of `out` (zeroed), in the pose of the file.
 *   of     out: [out->nt] what they are of, cones by the number of the body; the caller frees it
 *   rims   out: number of sides of triangles without a neighbour
 * Returns -1 with FL_SYSTEM. */
int fl_region_join(fl_part *out, fl_joined_triangle **of, int32_t *rims, const fl_region_surface *s,
                   fl_err *err);

#endif
