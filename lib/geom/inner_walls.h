/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inner_walls.h -- walls inside a surface, which nothing from outside can touch. */
#ifndef FL_GEOM_INNER_WALLS_H
#define FL_GEOM_INNER_WALLS_H
#include "geom/surface.h"

/* Leave out, with the vertices that they alone use,
 *   double walls, where bodies stand against each other: triangles on the same corners that face each other,
 *                 as far as they hang together, where the walls of both bodies go on along all of their rim;
 *                 a sheet with two sides has no such rim, and stays
 *   single walls, of which neither side looks outward (outer_skin.h)
 *   gone  so many triangles.  0, or -1 with FL_SYSTEM. */
int fl_part_drop_inner_walls(fl_part *p, int32_t *gone, fl_err *err);

/* Leave out fins: sheets of which each triangle has one that faces it from behind, that end in free edges and
 * stand on triangles which have none.  Both sides go, so that every edge that stays is run along as often one
 * way more than the other as before: with one of them a closed body would be open.  A sheet with two sides
 * that stands by itself stays.  gone as above. */
int fl_part_drop_fins(fl_part *p, int32_t *gone, fl_err *err);

/* Leave out the walls of closed bodies that stand against each other with the same corners, as tied or touching
 * blocks of finite elements do: pairs of triangles that face each other, as far as they hang together, where
 * the walls of both bodies go on along all of their rim, and those of a body that fills a cavity of another
 * one.  The bodies are then one, and the sum of their volumes is what it was.  Before that, triangles on the
 * same corners that look the same way are reduced to one.
 *   p   balanced: each edge is run along as often one way as the other
 *   gone, same   so many of either kind.  0, or -1 with FL_SYSTEM. */
int fl_part_drop_contact_walls(fl_part *p, int32_t *gone, int32_t *same, fl_err *err);

/* Leave out sheets with two sides that stand by themselves.  gone as above. */
int fl_part_drop_sheets(fl_part *p, int32_t *gone, fl_err *err);

#endif
