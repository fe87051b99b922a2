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

/* An edge in work: from x0 along u, and what its integral is multiplied by. */
typedef struct {
    fl_places *w;
    const fl_side *own;
    int32_t edge;
    fl_vec3 x0, u;
    double length, factor, R;
} fl_line;

/* Edge e of `own`, places to go into w; other: radius of the other core, R: reach. */
fl_line fl_strips_line(fl_places *w, const fl_side *own, int32_t e, double other, double R);

/* An edge over a face (whose prism reaches `behind` below it [m]), an edge, a vertex of `other`.  -1 when
 * memory runs out. */
int fl_strips_edge_face(const fl_line *l, const fl_side *other, int32_t f, double behind);
int fl_strips_edge_edge(const fl_line *l, const fl_side *other, int32_t g);
int fl_strips_edge_vertex(const fl_line *l, const fl_side *other, int32_t v);

/* Vertex v of `own` over a face, an edge, a vertex of `other`: a place when it lies in that prism, wedge,
 * cone.  Over a convex core it is in one; in an inner corner of a surface, in one for each wall. */
int fl_strips_vertex_face(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t f,
                          double R);
int fl_strips_vertex_edge(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t g,
                          double R);
int fl_strips_vertex_vertex(fl_places *w, const fl_side *own, int32_t v, const fl_side *other, int32_t c,
                            double R);

/* Edge e of `own` over the plane z = 0. */
int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e, double R);

#endif
