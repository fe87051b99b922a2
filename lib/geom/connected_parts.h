/* SPDX-License-Identifier: GPL-3.0-or-later */
/* connected_parts.h -- splits a surface into the bodies that it consists of. */
#ifndef FL_GEOM_CONNECTED_PARTS_H
#define FL_GEOM_CONNECTED_PARTS_H
#include "geom/surface.h"

/* Joins triangles across edges of two.  Where bodies share an edge, its triangles are joined in pairs in
 * their order, since the triangles of a body are consecutive in its file.  Edges with an odd number of
 * triangles above one join nothing.
 *   shell  [p->nt] out: the lowest triangle of its body
 *   odd    out: number of edges with an odd number of triangles; 0: each body is closed
 * 0, or -1 with FL_SYSTEM. */
int fl_part_connected(const fl_part *p, int32_t *shell, int32_t *odd, fl_err *err);

#endif
