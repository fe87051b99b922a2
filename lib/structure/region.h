/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region.h -- contact regions: surface that hangs together, across pieces and parts.
 *
 * The division of a structure into parts is for the sums of loads and must not bear on motion.  Two walls
 * that meet, each with rims of its own there, would load a body on the seam twice.  So pieces that touch
 * become one piece: the surface of their union (region_cut.h), whose seams are edges like any others, or
 * none at all where it is smooth (region_join.h).  The piece keeps its members, and the load of a contact
 * is split between their parts (contact/panel_load.h).
 *
 * Pieces that move apart stay separate: only those of parts with the same mover are joined.  So do those
 * whose union is longer than a period, those of which no closed surface results, and
 * more than 250 cones without other pieces, which would take half a minute to join.
 *
 * Limits.  Members touch if they are within 1e-6 of the size of the region.  A cone in a region is a
 * frustum of FL_CONE_SIDES sides and the same cross-section, but exact again for what is far enough from
 * other members (free_cone.h). */
#ifndef FL_STRUCTURE_REGION_H
#define FL_STRUCTURE_REGION_H
#include "structure/structure.h"

/* Joins the pieces of s that touch.
 *   mover    [surface->n] of each part; only equal ones are joined.  NULL: all are equal
 *   period   lengths of the periodic cell, 0: not periodic in that direction [m]
 * Returns -1 with FL_SYSTEM. */
int fl_regions_join(fl_structure *s, const fl_surface *surface, const int32_t *mover, fl_vec3 period,
                    fl_err *err);

#endif
