/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strips.h -- the places of edges: int s^(9/2) dl along an edge of one core over another (places.h).
 *
 * Along a straight line the distance to a polyhedron changes its formula where the nearest feature does: at
 * the planes between the prisms over its faces, the wedges over its edges and the cones over its vertices.
 * The line is cut there and where s becomes 0, and each piece gets the points of a rule of Gauss that knows
 * about the root of s at such an end: FL_LINE_NODES (rules.h) where s is linear, exact; else 8, or
 * FL_STRIP_CURVED where the overlap is large, within 2e-8, the force and its moment too.
 *
 * Edges wait until all that a contact has are known, and then go FL_LANES at a time.  Each has its places by
 * itself, and in the order in which they came: not a bit depends on what else there is. */
#ifndef FL_NARROW_STRIPS_H
#define FL_NARROW_STRIPS_H
#include "base/wide.h"
#include "narrow/places.h"

enum { FL_STRIP_CURVED = 10 };

/* A part of it, in [0, 1]. */
typedef struct {
    double lo, hi;
} fl_span;

/* Points closer to each other than this fraction of the size have no direction between them. */
#define FL_SPAN_SAME 1e-13

/* Keep of t what has a linear function >= 0, from its values at 0 and 1; 0 when nothing is left. */
static inline int fl_span_keep(fl_span *t, double a0, double a1)
{
    const int in0 = a0 >= 0.0, in1 = a1 >= 0.0;
    if (in0 && in1) return 1;
    if (!in0 && !in1) return 0;
    const double at = a0 / (a0 - a1);
    if (in1) t->lo = at > t->lo ? at : t->lo;
    else t->hi = at < t->hi ? at : t->hi;
    return t->lo < t->hi;
}

/* An edge in work: from x0 along u; its places go into w. */
typedef struct {
    fl_places *w;
    const fl_side *own;
    fl_vec3 x0, u;
    double factor; /* fl_strips_factor() */
} fl_line;

/* Edges by lanes: where they begin, their way; the part of it that counts, in [0, 1], none where lo >= hi;
 * fl_strips_factor(); radius and side of the core they belong to. */
typedef struct {
    double x[3][FL_LANES], u[3][FL_LANES];
    double lo[FL_LANES], hi[FL_LANES], factor[FL_LANES];
    double r[FL_LANES], side[FL_LANES];
} fl_strip_edges;

/* Over faces: their normals, and how high the ends are above them. */
typedef struct {
    fl_strip_edges of;
    double n[3][FL_LANES];
    double h0[FL_LANES], h1[FL_LANES];
} fl_strip_faces;

/* Over lines through c along the unit vectors e, or points c, e being 0; no nearer than `small`. */
typedef struct {
    fl_strip_edges of;
    double c[3][FL_LANES], e[3][FL_LANES];
    double small[FL_LANES];
} fl_strip_points;

/* Edges that wait: what struct fl_strips begins with. */
typedef struct {
    fl_strip_faces *face;
    fl_strip_points *point;
    int32_t faces, points;
    int32_t face_cap, point_cap;
} fl_strip_queue;

/* What int_0^1 s^(9/2) dt of edge e of `own` is multiplied by; other: radius of the other core.  0 for edges
 * without any. */
double fl_strips_factor(const fl_side *own, int32_t e, double other);

/* None waits; before the first that does.  -1 when memory runs out. */
int fl_strips_begin(fl_places *w);

/* One more four of those over faces, of those over points. -1 when memory runs out. */
int fl_strips_open_face(fl_strip_queue *s);
int fl_strips_open_point(fl_strip_queue *s);

FL_WIDE_PART void fl_strip_put(double to[3][FL_LANES], uint32_t l, fl_vec3 x)
{
    to[0][l] = x.x, to[1][l] = x.y, to[2][l] = x.z;
}

FL_WIDE_PART void fl_strip_put_edge(fl_strip_edges *e, uint32_t l, const fl_line *of, fl_span t)
{
    fl_strip_put(e->x, l, of->x0), fl_strip_put(e->u, l, of->u);
    e->lo[l] = t.lo, e->hi[l] = t.hi, e->factor[l] = of->factor;
    e->r[l] = of->own->r, e->side[l] = of->own->side;
}

/* Let the part t of an edge wait that lies over a face with normal n, h0 and h1 its heights at the two
 * ends of the edge; and over the point c, or the line through c along the unit vector *axis, no nearer
 * than `small`. -1 when memory runs out. */
FL_WIDE_PART int fl_strips_over_face(const fl_line *l, fl_span t, double h0, double h1, fl_vec3 n)
{
    fl_strip_queue *const s = (fl_strip_queue *)(void *)l->w->strips;
    const uint32_t k = (uint32_t)s->faces, lane = k % FL_LANES;
    if (lane == 0 && fl_strips_open_face(s)) return -1;
    fl_strip_faces *const f = &s->face[k / FL_LANES];
    fl_strip_put_edge(&f->of, lane, l, t), fl_strip_put(f->n, lane, n);
    f->h0[lane] = h0, f->h1[lane] = h1;
    s->faces++;
    return 0;
}
FL_WIDE_PART int fl_strips_over_point(const fl_line *l, fl_span t, fl_vec3 c, const fl_vec3 *axis,
                                      double small)
{
    fl_strip_queue *const s = (fl_strip_queue *)(void *)l->w->strips;
    const uint32_t k = (uint32_t)s->points, lane = k % FL_LANES;
    if (lane == 0 && fl_strips_open_point(s)) return -1;
    fl_strip_points *const p = &s->point[k / FL_LANES];
    fl_strip_put_edge(&p->of, lane, l, t), fl_strip_put(p->c, lane, c);
    fl_strip_put(p->e, lane, axis ? *axis : v3(0, 0, 0));
    p->small[lane] = small;
    s->points++;
    return 0;
}

/* The places of all that wait, those over faces first, with the reach R.  -1 when memory runs out. */
int fl_strips_places(fl_places *w, double R);

/* The places of so many fours, all lanes of which are filled. */
int fl_strips_of_faces(fl_places *w, const fl_strip_faces *q, int32_t fours, double R);
int fl_strips_of_points(fl_places *w, const fl_strip_points *q, int32_t fours, double R);

/* Let edge e of `own` wait over the plane z = 0. */
int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e);

void fl_strips_free(struct fl_strips *s); /* of fl_places; takes NULL */

#endif
