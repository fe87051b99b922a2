/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vertex_fans.h -- vertices whose triangles cannot cross each other. */
#ifndef FL_MESH_VERTEX_FANS_H
#define FL_MESH_VERTEX_FANS_H
#include "geom/surface.h"

/* Set simple[v] to 1 where the triangles at v certainly meet only in v and in the edges they share, else to
 * 0.
 *
 * Seen along a direction d, each triangle (v, a, b) at v is a sector from a to b of less than half a turn.
 * It winds one way if d . (a - v) x (b - v) > 0.  Two cases are recognised:
 *   ring    each edge at v begins one sector and ends one, in one cycle.  A turn about v then leaves and
 *           enters sectors in pairs, so every direction is covered by the same number of sectors.
 *   chain   the sectors lead from one boundary edge to another, as at the rim of a plate.  Directions from
 *           the first side on to the last are then covered once more than the others.
 * If the direction next to the first side is covered once, sectors share no more than their sides, and
 * triangles no more than the edges above these.  d is the sum of the normals.  Branched, twisted and folded
 * fans are not simple, nor fans of more than FL_VERTEX_FAN_MAX triangles.
 *   p        welded: coincident points must be one vertex
 *   simple   [p->nv] out
 * Runs on all threads.  Returns 0, or -1 with FL_SYSTEM. */
enum { FL_VERTEX_FAN_MAX = 1 << 18 };
int fl_vertex_fans_simple(const fl_part *p, uint8_t *simple, fl_err *err);

#endif
