/* SPDX-License-Identifier: GPL-3.0-or-later */
/* edge_integral.h -- edge term of the law `patch`: int s^(9/2) dl along an edge of one core over the other
 * core (patch_law.h), as patch points.
 *
 * The distance of a point on a straight line from a polyhedron is a different formula in each Voronoi region:
 * the prism over a face, the wedge over an edge, the cone over a vertex.  The line is cut where it passes
 * from one region to the next and where s = 0.  Each piece is integrated by a Gauss rule that accounts for
 * the root of s at such an end.  Where s is linear (over a face) FL_LINE_NODES nodes are exact
 * (quadrature_line.h).  Elsewhere 8 nodes, or FL_EDGE_CURVED_NODES for large overlaps, are within 2e-8 in
 * energy, force and moment.
 *
 * Edges are queued until all edges of a contact are known, then evaluated FL_SIMD_WIDTH at a time.  The
 * points of an edge do not depend on the other edges, and they come in the order of the queue. */
#ifndef FL_PATCH_EDGE_INTEGRAL_H
#define FL_PATCH_EDGE_INTEGRAL_H
#include "base/simd.h"
#include "patch/patch_types.h"

enum { FL_EDGE_CURVED_NODES = 10 };

/* Part of an edge, as parameters in [0, 1]. */
typedef struct {
    double lo, hi;
} fl_edge_span;

/* Two points nearer to each other than this fraction of the size of the core have no direction between them:
 * it would be rounding. */
#define FL_SAME_POINT_TOL 1e-13

/* Keeps the part of t in which a linear function is >= 0, a0 and a1 its values at 0 and 1.  Returns 0 when
 * nothing is left. */
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

/* An edge to queue: from x0 along u (the whole edge); its points are added to w. */
typedef struct {
    fl_patch_points *w;
    const fl_patch_core *own;
    fl_vec3 x0, u;
    double factor; /* fl_edge_integral_factor() */
} fl_edge_line;

/* Edges, one a lane: start x, vector u, the part [lo, hi] of [0, 1] to integrate (none where lo >= hi),
 * fl_edge_integral_factor(), dilation radius and side of the core that has the edge. */
typedef struct {
    double x[3][FL_SIMD_WIDTH], u[3][FL_SIMD_WIDTH];
    double lo[FL_SIMD_WIDTH], hi[FL_SIMD_WIDTH], factor[FL_SIMD_WIDTH];
    double r[FL_SIMD_WIDTH], side[FL_SIMD_WIDTH];
} fl_edge_lanes;

/* Edges over faces: normals n of the faces, heights h0 and h1 of the ends of the edge over them. */
typedef struct {
    fl_edge_lanes of;
    double n[3][FL_SIMD_WIDTH];
    double h0[FL_SIMD_WIDTH], h1[FL_SIMD_WIDTH];
} fl_edge_face_lanes;

/* Edges over lines through c along the unit vectors e, or over points c where e = 0.  Nodes nearer than
 * `small` to the line or point do not count. */
typedef struct {
    fl_edge_lanes of;
    double c[3][FL_SIMD_WIDTH], e[3][FL_SIMD_WIDTH];
    double small[FL_SIMD_WIDTH];
} fl_edge_point_lanes;

/* The queue; first member of struct fl_edge_integral. */
typedef struct {
    fl_edge_face_lanes *face;
    fl_edge_point_lanes *point;
    int32_t faces, points;
    int32_t face_cap, point_cap;
} fl_edge_queue;

/* Factor of int_0^1 s^(9/2) dt in U for edge e of `own`: w L (256/315) sqrt(2 rho) times the length.  0 for
 * an edge without an edge term.
 *     other   dilation radius of the other core [m] */
double fl_edge_integral_factor(const fl_patch_core *own, int32_t e, double other);

/* Empties the queue.  -1 when memory runs out. */
int fl_edge_integral_begin(fl_patch_points *w);

/* Add four empty lanes over faces, over points.  -1 when memory runs out. */
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

/* Queue the part t of edge l: over a face with unit normal n, h0 and h1 the heights of the ends of the edge;
 * over the point c, or the line through c along the unit vector *axis, `small` as in fl_edge_point_lanes.  -1
 * when memory runs out. */
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

/* Adds the points of all queued edges to their fl_patch_points, edges over faces first.  R: reach [m].  -1
 * when memory runs out. */
int fl_edge_integral_finish(fl_patch_points *w, double R);

/* Add the points of `fours` groups of four edges, without the queue; every lane must be set. */
int fl_edge_integral_over_faces(fl_patch_points *w, const fl_edge_face_lanes *q, int32_t fours, double R);
int fl_edge_integral_over_points(fl_patch_points *w, const fl_edge_point_lanes *q, int32_t fours, double R);

/* Queues edge e of `own` over the plane z = 0. */
int fl_edge_queue_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t e);

void fl_edge_integral_free(struct fl_edge_integral *s); /* takes NULL */

#endif
