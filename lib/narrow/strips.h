/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strips.h -- the places of edges: int s^(9/2) dl along an edge of one core over another (places.h).
 *
 * Along a straight line the distance to a polyhedron changes its formula where the nearest feature does: at
 * the planes between the prisms over its faces, the wedges over its edges and the cones over its vertices.
 * The line is cut there and where s becomes 0, and each piece gets the points of a rule of Gauss that knows
 * about the root of s at such an end: FL_STRIP_NODES where s is linear, exact; else FL_STRIP_CURVED, within
 * 1e-8. */
#ifndef FL_NARROW_STRIPS_H
#define FL_NARROW_STRIPS_H
#include "narrow/places.h"

enum { FL_STRIP_NODES = 6, FL_STRIP_CURVED = 10 };

/* Edge e of `own` over the listed features of `other`; reach is R.  All pieces go into w in a fixed order.
 *   behind  how far below a face its prism reaches [m]
 * -1 when memory runs out. */
int fl_strips_edge(fl_places *w, const fl_side *own, int32_t e, const fl_side *other, const fl_reach *near,
                   double R, double behind);

/* Vertex v of `own` over the listed features of `other`: a place for every prism, wedge and cone that it lies
 * in.  Over a convex core that is one; in an inner corner of a surface, one for each wall. */
int fl_strips_vertex(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, const fl_reach *near,
                     double R);

/* Edge e of `own` over the plane z = 0. */
int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e, double R);

#endif
