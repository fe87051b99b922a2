/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crossing.h -- pairs of triangles of a part that meet where they are not joined, over all threads. */
#ifndef FL_MESH_CROSSING_H
#define FL_MESH_CROSSING_H
#include "geom/surface.h"
#include "shim/cgal_crossing.h"

/* Count the pairs as fl_cgal_crossings() does, and find the same.  Triangles are put in the order of a curve
 * that fills space and boxed by eights.  Of pairs whose boxes meet, those with a tame vertex in common
 * (vertex_fans.h) do not cross, which leaves few of a sound surface; of the others those that a plane parts for
 * certain in double precision (tri_separation.h) are passed over, and exact arithmetic decides on the rest.  The
 * numbers do not depend on the number of threads; beyond 2^31 - 1 they stay there.
 *   p   what is one point must be one vertex where it is to count as common: weld first
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err.
 * Source: Morton, IBM Ottawa (1966), the curve. */
int fl_part_crossings(const fl_part *p, fl_crossing *c, fl_err *err);

#endif
