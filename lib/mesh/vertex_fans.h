/* SPDX-License-Identifier: GPL-3.0-or-later */
/* vertex_fans.h -- vertices about which the triangles of a part lie like the petals of an open flower: no two of
 * these can cross. */
#ifndef FL_MESH_VERTEX_FANS_H
#define FL_MESH_VERTEX_FANS_H
#include "geom/surface.h"

/* tame[v] becomes 1 where for certain the triangles at v meet one another nowhere but in v and in the edges
 * that two of them share; 0 where that is not known.
 *
 * Seen along some d, each triangle (v, a, b) at v is a sector from a to b of less than half a turn, and winds
 * one way when d . (a - v) x (b - v) > 0.  Where every edge at v is the beginning of one sector and the end
 * of one, in one ring, a turn about v leaves and enters sectors in pairs: their number over a direction is
 * the same for all directions.  Where they form a chain from one rim to another, as at the rim of a plate, it
 * is one more from the first side on to the last one than elsewhere.  If it is one behind the first side,
 * sectors have nothing in common but their sides, and triangles no more than what lies above these: their
 * common edges.  d is the sum of the normals, and the direction next to the first side is looked at.  Forks,
 * twisted and folded fans are not tame, nor those of more than FL_VERTEX_FAN_MAX triangles.
 *   p      what is one point must be one vertex: weld first
 *   tame   [p->nv] out
 * Work is shared by all threads.  Returns 0, or -1 with FL_SYSTEM. */
enum { FL_VERTEX_FAN_MAX = 1 << 18 };
int fl_vertex_fans_simple(const fl_part *p, uint8_t *tame, fl_err *err);

#endif
