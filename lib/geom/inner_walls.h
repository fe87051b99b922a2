/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inner_walls.h -- removes inner walls of a surface, which nothing from outside can touch. */
#ifndef FL_GEOM_INNER_WALLS_H
#define FL_GEOM_INNER_WALLS_H
#include "geom/surface.h"

/* Removes, with the vertices that only they use,
 *   double walls, where bodies stand against each other: triangles on the same corners that face each other,
 *   as
 *                 connected sets with the walls of both bodies continuing along the whole boundary;
 *                 a two-sided sheet has no such boundary and stays
 *   single walls, of which neither side faces outward (outer_skin.h)
 *   removed  out: number of removed triangles.  0, or -1 with FL_SYSTEM. */
int fl_part_drop_inner_walls(fl_part *p, int32_t *removed, fl_err *err);

/* Removes fins: sheets whose triangles all have a twin facing them from behind, which end in free edges and
 * stand on triangles without a twin.  Both sides are removed, so that every remaining edge keeps the balance
 * of its two directions; removing one side would open a closed body.  A two-sided sheet that stands alone
 * stays.  removed as above. */
int fl_part_drop_fins(fl_part *p, int32_t *removed, fl_err *err);

/* Removes the walls of closed bodies that stand against each other with the same corners, as tied or touching
 * blocks of finite elements do: connected sets of pairs of triangles that face each other, with the walls of
 * both bodies continuing along the whole boundary, and those between a cavity and a body that fills it.  The
 * bodies are then one, and the sum of their volumes is unchanged.  Before that, triangles on the same corners
 * with the same orientation are reduced to one.
 *   p   balanced: each edge has as many half-edges in either direction
 *   removed, same   out: number of triangles of either kind.  0, or -1 with FL_SYSTEM. */
int fl_part_drop_contact_walls(fl_part *p, int32_t *removed, int32_t *same, fl_err *err);

/* Removes two-sided sheets that stand alone.  removed as above. */
int fl_part_drop_sheets(fl_part *p, int32_t *removed, fl_err *err);

#endif
