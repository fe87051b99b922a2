/* SPDX-License-Identifier: GPL-3.0-or-later */
/* edge_integral.h -- the places of edges: int s^(9/2) dl along an edge of one core over another (patch_points.h).
 *
 * Along a straight line the distance to a polyhedron changes its formula where the nearest feature does: at
 * the planes between the prisms over its faces, the wedges over its edges and the cones over its vertices.
 * The line is cut there and where s becomes 0, and each piece gets the points of a rule of Gauss that knows
 * about the root of s at such an end: FL_LINE_NODES (quadrature_rules.h) where s is linear, exact; else 8, or
 * FL_EDGE_CURVED_NODES where the overlap is large, within 2e-8, the force and its moment too.
 *
 * Edges wait until all that a contact has are known, and then go FL_SIMD_WIDTH at a time.  Each has its places by
 * itself, and in the order in which they came: not a bit depends on what else there is. */
#ifndef FL_PATCH_EDGE_INTEGRAL_H
#define FL_PATCH_EDGE_INTEGRAL_H
#include "base/simd.h"
#include "patch/patch_types.h"

enum { FL_EDGE_CURVED_NODES = 10 };

/* A part of it, in [0, 1]. */
typedef struct {
    double lo, hi;
} fl_edge_span;

/* Points closer to each other than this fraction of the size have no direction between them. */
#define FL_SAME_POINT_TOL 1e-13

/* Keep of t what has a linear function >= 0, from its values at 0 and 1; 0 when nothing is left. */
static inline int fl_edge_span_clip(fl_edge_span *t, double a0, double a1)
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
    fl_patch_points *w;
    const fl_patch_core *own;
    fl_vec3 x0, u;
    double factor; /* fl_edge_integral_factor() */
} fl_edge_line;

/* Edges by lanes: where they begin, their way; the part of it that counts, in [0, 1], none where lo >= hi;
 * fl_edge_integral_factor(); radius and side of the core they belong to. */
typedef struct {
    double x[3][FL_SIMD_WIDTH], u[3][FL_SIMD_WIDTH];
    double lo[FL_SIMD_WIDTH], hi[FL_SIMD_WIDTH], factor[FL_SIMD_WIDTH];
    double r[FL_SIMD_WIDTH], side[FL_SIMD_WIDTH];
} fl_edge_lanes;

/* Over faces: their normals, and how high the ends are above them. */
typedef struct {
    fl_edge_lanes of;
    double n[3][FL_SIMD_WIDTH];
    double h0[FL_SIMD_WIDTH], h1[FL_SIMD_WIDTH];
} fl_edge_face_lanes;

/* Over lines through c along the unit vectors e, or points c, e being 0; no nearer than `small`. */
typedef struct {
    fl_edge_lanes of;
    double c[3][FL_SIMD_WIDTH], e[3][FL_SIMD_WIDTH];
    double small[FL_SIMD_WIDTH];
} fl_edge_point_lanes;

/* Edges that wait: what struct fl_edge_integral begins with. */
typedef struct {
    fl_edge_face_lanes *face;
    fl_edge_point_lanes *point;
    int32_t faces, points;
    int32_t face_cap, point_cap;
} fl_edge_queue;

/* What int_0^1 s^(9/2) dt of edge e of `own` is multiplied by; other: radius of the other core.  0 for edges
 * without any. */
double fl_edge_integral_factor(const fl_patch_core *own, int32_t e, double other);

/* None waits; before the first that does.  -1 when memory runs out. */
int fl_edge_integral_begin(fl_patch_points *w);

/* One more four of those over faces, of those over points. -1 when memory runs out. */
int fl_edge_queue_grow_faces(fl_edge_queue *s);
int fl_edge_queue_grow_points(fl_edge_queue *s);

FL_SIMD_INLINE void fl_edge_lane_set_vector(double to[3][FL_SIMD_WIDTH], uint32_t l, fl_vec3 x)
{
    to[0][l] = x.x, to[1][l] = x.y, to[2][l] = x.z;
}

FL_SIMD_INLINE void fl_edge_lane_set(fl_edge_lanes *e, uint32_t l, const fl_edge_line *of, fl_edge_span t)
{
    fl_edge_lane_set_vector(e->x, l, of->x0), fl_edge_lane_set_vector(e->u, l, of->u);
    e->lo[l] = t.lo, e->hi[l] = t.hi, e->factor[l] = of->factor;
    e->r[l] = of->own->r, e->side[l] = of->own->side;
}

/* Let the part t of an edge wait that lies over a face with normal n, h0 and h1 its heights at the two
 * ends of the edge; and over the point c, or the line through c along the unit vector *axis, no nearer
 * than `small`. -1 when memory runs out. */
FL_SIMD_INLINE int fl_edge_queue_over_face(const fl_edge_line *l, fl_edge_span t, double h0, double h1,
                                           fl_vec3 n)
{
    fl_edge_queue *const s = (fl_edge_queue *)(void *)l->w->edges;
    const uint32_t k = (uint32_t)s->faces, lane = k % FL_SIMD_WIDTH;
    if (lane == 0 && fl_edge_queue_grow_faces(s)) return -1;
    fl_edge_face_lanes *const f = &s->face[k / FL_SIMD_WIDTH];
    fl_edge_lane_set(&f->of, lane, l, t), fl_edge_lane_set_vector(f->n, lane, n);
    f->h0[lane] = h0, f->h1[lane] = h1;
    s->faces++;
    return 0;
}
FL_SIMD_INLINE int fl_edge_queue_over_point(const fl_edge_line *l, fl_edge_span t, fl_vec3 c,
                                            const fl_vec3 *axis, double small)
{
    fl_edge_queue *const s = (fl_edge_queue *)(void *)l->w->edges;
    const uint32_t k = (uint32_t)s->points, lane = k % FL_SIMD_WIDTH;
    if (lane == 0 && fl_edge_queue_grow_points(s)) return -1;
    fl_edge_point_lanes *const p = &s->point[k / FL_SIMD_WIDTH];
    fl_edge_lane_set(&p->of, lane, l, t), fl_edge_lane_set_vector(p->c, lane, c);
    fl_edge_lane_set_vector(p->e, lane, axis ? *axis : v3(0, 0, 0));
    p->small[lane] = small;
    s->points++;
    return 0;
}

/* The places of all that wait, those over faces first, with the reach R.  -1 when memory runs out. */
int fl_edge_integral_finish(fl_patch_points *w, double R);

/* The places of so many fours, all lanes of which are filled. */
int fl_edge_integral_over_faces(fl_patch_points *w, const fl_edge_face_lanes *q, int32_t fours, double R);
int fl_edge_integral_over_points(fl_patch_points *w, const fl_edge_point_lanes *q, int32_t fours, double R);

/* Let edge e of `own` wait over the plane z = 0. */
int fl_edge_queue_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t e);

void fl_edge_integral_free(struct fl_edge_integral *s); /* of fl_patch_points; takes NULL */

#endif
