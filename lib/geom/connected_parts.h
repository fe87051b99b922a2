/* SPDX-License-Identifier: GPL-3.0-or-later */
/* connected_parts.h -- the bodies that a surface was put together of. */
#ifndef FL_GEOM_CONNECTED_PARTS_H
#define FL_GEOM_CONNECTED_PARTS_H
#include "geom/surface.h"

/* Triangles joined across edges of two; and where bodies share an edge, by twos in their order, since the
 * triangles of a body come one behind the other in its file.  Edges of three, or five, join nothing.
 *   shell  [p->nt] out: the lowest triangle of its body
 *   odd    out: how many edges have an odd number of triangles; 0: each body is closed
 * 0, or -1 with FL_SYSTEM. */
int fl_part_connected(const fl_part *p, int32_t *shell, int32_t *odd, fl_err *err);

#endif
