/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crossing.h -- pairs of triangles of a part that intersect where they are not joined, on all threads. */
#ifndef FL_MESH_CROSSING_H
#define FL_MESH_CROSSING_H
#include "geom/surface.h"
#include "shim/cgal_crossing.h"

/* Count the pairs that cross and touch, with the same result as fl_cgal_crossings().
 *   1. Triangles are sorted along a Morton curve and grouped into a tree of boxes, eight to a box.
 *   2. Of two triangles whose boxes overlap, those with a common simple vertex (vertex_fans.h) do not cross.
 *      In a sound surface this leaves few pairs.
 *   3. Pairs that a plane certainly separates in double precision (tri_separation.h) are skipped.
 *   4. Exact arithmetic decides the rest.
 * The counts do not depend on the number of threads; they saturate at 2^31 - 1.
 *   p   welded: coincident points must be one vertex to count as common
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err.  Source of the curve: Morton, IBM Ottawa (1966). */
int fl_part_crossings(const fl_part *p, fl_crossing *c, fl_err *err);

#endif
