/* SPDX-License-Identifier: GPL-3.0-or-later */
/* outer_skin.h -- the outer skin of a surface with inner walls.
 *
 * Where more than two triangles meet in an edge (a hull and its bulkheads, two boxes with a common wall), the
 * surface divides space into cells, and a patch encloses no volume of its own.  The triangles about an edge
 * are sorted by angle: the front of one and the facing side of the next bound the same cell.  One cell is
 * unbounded; a ray from far away first meets the surface from there. */
#ifndef FL_GEOM_OUTER_SKIN_H
#define FL_GEOM_OUTER_SKIN_H
#include "geom/edges.h"

enum { FL_OUTER_NONE = 0, FL_OUTER_FRONT = 1, FL_OUTER_BACK = 2, FL_OUTER_BOTH = 3 };

/* Finds the sides of the triangles of p that face the unbounded cell of their connected set: FRONT (the side
 * of the normal) or BACK for the skin, NONE for inner triangles, BOTH for a sheet.
 *   e      edges of p
 *   side   [p->nt] out.  BOTH also where the result is unknown: where no edge of the set has an odd number of
 *          triangles, as with closed bodies that share edges, and where triangles at an edge partly coincide
 * Valid for surfaces without self-intersection.  0, or -1 with FL_SYSTEM. */
int fl_part_outer_sides(const fl_part *p, const fl_edges *e, uint8_t *side, fl_err *err);

#endif
