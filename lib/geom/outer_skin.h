/* SPDX-License-Identifier: GPL-3.0-or-later */
/* outer_skin.h -- the skin of a surface with walls inside it.
 *
 * Where more than two triangles meet in an edge (a hull and its bulkheads, two boxes that share a wall)
 * the surface parts space into cells, and the volume of a patch tells nothing, as it is no body's.  The
 * triangles about an edge, in the order of their angles, tell which of their sides look into the same
 * cell: the front of one and that side of the next which faces it.  One cell has no bounds: a ray that
 * comes from far away meets the surface first from there. */
#ifndef FL_GEOM_OUTER_SKIN_H
#define FL_GEOM_OUTER_SKIN_H
#include "geom/edges.h"

enum { FL_OUTER_NONE = 0, FL_OUTER_FRONT = 1, FL_OUTER_BACK = 2, FL_OUTER_BOTH = 3 };

/* Which sides of the triangles of p look outward, into the cell without bounds of what they hang together
 * with: FRONT, the side of the normal, or BACK for the skin, NONE for what lies inside, BOTH for a sheet. e
 * of p side  [p->nt] out.  BOTH, too, where nothing is known: where no edge of what hangs together has an
 * odd number of triangles, as where closed bodies have edges in common, and where triangles at an edge lie
 * on one another in part It holds for surfaces that do not pass through themselves.  0, or -1 with
 * FL_SYSTEM. */
int fl_part_outer_sides(const fl_part *p, const fl_edges *e, uint8_t *side, fl_err *err);

#endif
