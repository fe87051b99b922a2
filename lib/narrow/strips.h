/* SPDX-License-Identifier: GPL-3.0-or-later */
/* strips.h -- the places of edges: int s^(9/2) dl along an edge of one core over another (places.h).
 *
 * Along a straight line the distance to a polyhedron changes its formula where the nearest feature does: at
 * the planes between the prisms over its faces, the wedges over its edges and the cones over its vertices.
 * The line is cut there and where s becomes 0, and each piece gets the points of a rule of Gauss that knows
 * about the root of s at such an end: FL_LINE_NODES (rules.h) where s is linear, exact; else
 * 8, or FL_STRIP_CURVED where the overlap is large, within 1e-8. */
#ifndef FL_NARROW_STRIPS_H
#define FL_NARROW_STRIPS_H
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
    double R;      /* reach */
} fl_line;

/* An edge that has its foot on a line or a point: the part of it that counts, from where it is nearest; m,
 * where that is; tau + t slope, where the line is met; q and u, the nearest point and the way across the
 * line, and their squares. */
typedef struct {
    fl_span t;
    double m, tau, slope, uu, least2;
    fl_vec3 q, u;
} fl_strip_foot;

/* What int_0^1 s^(9/2) dt of edge e of `own` is multiplied by; other: radius of the other core.  0 for edges
 * without any. */
double fl_strips_factor(const fl_side *own, int32_t e, double other);

/* The part t of an edge over a face with normal n, h0 and h1 its heights at the two ends of the edge; and
 * over the point c, or the line through c along the unit vector *axis, no nearer than `small`.  -1 when
 * memory runs out. */
int fl_strips_over_face(const fl_line *l, fl_span t, double h0, double h1, fl_vec3 n);
int fl_strips_over_point(const fl_line *l, fl_span t, fl_vec3 c, const fl_vec3 *axis, double small);

/* The same where the foot is known and within R; x0 and u of l are not asked for. */
int fl_strips_at_foot(const fl_line *l, const fl_strip_foot *at, fl_vec3 c, const fl_vec3 *axis,
                      double small);

/* Edge e of `own` over the plane z = 0. */
int fl_strips_plane(fl_places *w, const fl_side *own, int32_t e, double R);

#endif
