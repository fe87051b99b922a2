/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/plane_distances.h"
#include <math.h>
#include <stddef.h>
#include "base/array.h"
#include "base/simd.h"
#include "patch/edge_integral.h"
#include "patch/face_integral.h"
#include "patch/patch_law.h"

/* Rounding of the distance of a point from a plane, over the coordinates and sizes. */
#define ON_PLANE_TOL 4e-15

/* Distances h = g.x - c of points x, y, z from planes, from all or those in the list; `columns` points, a
 * multiple of FL_SIMD_WIDTH.  A point on a plane gets the distance fl_plane_tie_offset(), for every query.  A
 * point counts as on the plane when |h| <= near |g|_1: planes that coincide are rounded separately, and a
 * point on all of them must be on the same side of each. */
FL_SIMD_VERSIONS static void tabulate_distances(const fl_core_plane *cut, const int32_t *list, int32_t planes,
                                                const double *x, const double *y, const double *z,
                                                int32_t columns, double near, double *h)
{
    for (int32_t c = 0; c < planes; c++) {
        const int32_t k = list ? list[c] : c;
        const fl_core_plane p = cut[k];
        const double offset = fl_plane_tie_offset(p.g);
        const double on = near * (fabs(p.g.x) + fabs(p.g.y) + fabs(p.g.z));
        for (int32_t v = 0; v < columns; v += FL_SIMD_WIDTH) {
            const fl_simd X = *(const fl_simd *)(x + v), Y = *(const fl_simd *)(y + v);
            const fl_simd Z = *(const fl_simd *)(z + v), up = p.g.x * X + p.g.y * Y + p.g.z * Z - p.c;
            *(fl_simd *)(h + (int64_t)k * columns + v) = FL_SIMD_MASKED((up > on) | (up < -on), up) + offset;
        }
    }
}

#define INLINE static inline __attribute__((always_inline))

/* Loads n vertices, their numbers beginning at integer `from`: all x, then y, then z, padded to full
 * registers. */
INLINE void load_vertices(const fl_vec3 *v, const void *integers, int width, int32_t from, int32_t n,
                          int32_t columns, double *x)
{
    for (int32_t k = 0; k < columns; k++, x++) {
        const fl_vec3 *const r = &v[fl_feature_integer(integers, width, from + (k < n ? k : n - 1))];
        x[0] = r->x, x[columns] = r->y, x[2 * columns] = r->z;
    }
}

/* Inverse of M r + o. */
FL_SIMD_VERSIONS static void to_frame_of_a(double *x, int32_t columns, const fl_mat3 *M, fl_vec3 o)
{
    double *const y = x + columns, *const z = y + columns;
    for (int32_t k = 0; k < columns; k += FL_SIMD_WIDTH) {
        const fl_simd X = FL_SIMD_LOAD(x + k) - o.x, Y = FL_SIMD_LOAD(y + k) - o.y,
                      Z = FL_SIMD_LOAD(z + k) - o.z;
        FL_SIMD_STORE(x + k) = M->m[0][0] * X + M->m[1][0] * Y + M->m[2][0] * Z;
        FL_SIMD_STORE(y + k) = M->m[0][1] * X + M->m[1][1] * Y + M->m[2][1] * Z;
        FL_SIMD_STORE(z + k) = M->m[0][2] * X + M->m[1][2] * Y + M->m[2][2] * Z;
    }
}

/* Fills the table of one direction.  0: vertices of A, transformed, from planes of B; 1: vertices of B, in
 * the frame of A, from planes of A. */
static int fill_table(fl_patch_points *w, const fl_feature_pairs *l, int direction, const fl_vec3 *own,
                      const fl_poly *other, double near, const double **out)
{
    fl_distance_table *s = &w->distances[direction];
    const int32_t vertices = l->vertices[direction], from = direction ? l->vertices[0] : 0,
                  cuts = l->planes[direction];
    const int32_t columns = fl_feature_columns(vertices);
    const void *integers = fl_feature_pairs_integers(l);
    const int width = l->width;
    if (fl_reserve(&s->x, &s->x_cap, 3 * (int64_t)columns, sizeof *s->x) ||
        fl_reserve(&s->h, &s->h_cap, (int64_t)cuts * (columns + 4), sizeof *s->h))
        return -1;
    double *const x = s->x, *const y = x + columns, *const z = y + columns;
    if (width == 0) load_vertices(own, integers, 0, from, vertices, columns, x);
    else load_vertices(own, integers, width, from, vertices, columns, x);
    if (direction) to_frame_of_a(x, columns, &w->M, w->o);
    const int32_t *list = l->selection ? l->selection->plane[direction] : NULL;
    fl_core_plane *const made = (fl_core_plane *)(void *)(s->h + (int64_t)cuts * columns);
    if (!l->stores_planes) fl_feature_pairs_make_planes(l, direction, other, made);
    tabulate_distances(l->stores_planes ? fl_feature_pairs_planes(l, direction) : made, list,
                       list ? l->selection->planes[direction] : cuts, x, y, z, columns,
                       l->stores_planes ? 0.0 : near, s->h);
    *out = s->h;
    return 0;
}

/* What the evaluation of a pair needs. */
typedef struct {
    fl_patch_points *w;
    const double *number;
    const fl_patch_core *own, *other;
    const double *h; /* table of this direction */
    size_t columns;  /* length of its rows */
    double R, prism_depth, rim;
} pair_context;

/* A row of the list. */
typedef const void *row_pointer;

INLINE int32_t integer_at(row_pointer r, int width, int32_t k) { return fl_feature_integer(r, width, k); }

/* Distances from plane k. */
INLINE const double *distances_from(const pair_context *q, int32_t k)
{
    return q->h + (uint32_t)k * q->columns;
}

/* True if a vertex lies beyond all n sides, which follow the first `fixed` integers. */
INLINE int vertex_beyond_sides(const pair_context *q, row_pointer r, int width, int fixed, int32_t n,
                               int32_t v)
{
    for (int32_t k = 0; k < n; k++) {
        const int32_t side = integer_at(r, width, fixed + k);
        const double h = distances_from(q, side >> 1)[v];
        if (side & 1 ? h > 0.0 : h < 0.0) return 0;
    }
    return 1;
}

/* Clips an edge to the part beyond all sides. */
INLINE int clip_by_sides(const pair_context *q, row_pointer r, int width, int fixed, int32_t n, int32_t v0,
                         int32_t v1, fl_edge_span *t)
{
    for (int32_t k = 0; k < n; k++) {
        const int32_t side = integer_at(r, width, fixed + k);
        const double *h = distances_from(q, side >> 1), h0 = h[v0], h1 = h[v1];
        if (!(side & 1 ? fl_edge_span_clip(t, -h0, -h1) : fl_edge_span_clip(t, h0, h1))) return 0;
    }
    return 1;
}

/* Adds vertex v, r its vector from the nearest point of an edge or a vertex. */
static int add_vertex_near_point(const pair_context *q, int32_t v, fl_vec3 r)
{
    const double d = v3_norm(r);
    if (d >= q->R || d <= FL_SAME_POINT_TOL * q->other->p->size) return 0;
    return fl_patch_points_add_vertex(q->w, q->own, q->other->r, v, v3_scale(1.0 / d, r), q->R - d);
}

INLINE int add_vertex(const pair_context *q, row_pointer r, int width, int kind, int32_t n)
{
    const fl_poly *p = q->other->p;
    const int32_t own = integer_at(r, width, FL_ROW_OWN), other = integer_at(r, width, FL_ROW_OTHER),
                  v = integer_at(r, width, FL_ROW_COLUMN);
    if (kind == FL_PAIR_VERTEX_FACE) {
        const double h = distances_from(q, integer_at(r, width, FL_ROW_COLUMN + 1))[v];
        if (h >= q->R || h < -FL_SAME_POINT_TOL * p->size || !vertex_beyond_sides(q, r, width, 5, n, v))
            return 0;
        return fl_patch_points_add_vertex(q->w, q->own, q->other->r, own, q->other->n[other], q->R - h);
    }
    if (!vertex_beyond_sides(q, r, width, kind == FL_PAIR_VERTEX_VERTEX ? 4 : 5, n, v)) return 0;
    if (kind == FL_PAIR_VERTEX_VERTEX)
        return add_vertex_near_point(q, own, v3_sub(q->own->v[own], q->other->v[other]));
    const fl_edge g = p->edge[other];
    const double length = q->number[integer_at(r, width, FL_ROW_COLUMN + 1)];
    const fl_vec3 a = q->other->v[g.a], e = v3_scale(1.0 / length, v3_sub(q->other->v[g.b], a));
    const fl_vec3 direction = v3_sub(q->own->v[own], a);
    return add_vertex_near_point(q, own, v3_madd(direction, -v3_dot(direction, e), e));
}

INLINE int queue_edge(const pair_context *q, row_pointer r, int width, int kind, int32_t n)
{
    const fl_poly *p = q->other->p;
    const int32_t own = integer_at(r, width, FL_ROW_OWN), other = integer_at(r, width, FL_ROW_OTHER),
                  v0 = integer_at(r, width, FL_ROW_COLUMN), v1 = integer_at(r, width, FL_ROW_SECOND_COLUMN);
    const double small = FL_SAME_POINT_TOL * p->size;
    double h0 = 0.0, h1 = 0.0;
    fl_edge_span t = {0.0, 1.0};
    if (kind == FL_PAIR_EDGE_FACE) {
        const double *h = distances_from(q, integer_at(r, width, FL_ROW_FACTOR + 1)),
                     below = q->prism_depth + small;
        h0 = h[v0], h1 = h[v1];
        if ((h0 >= q->R && h1 >= q->R) || !fl_edge_span_clip(&t, h0 + below, h1 + below)) return 0;
    }
    if (!clip_by_sides(q, r, width, kind == FL_PAIR_EDGE_VERTEX ? 6 : 7, n, v0, v1, &t)) return 0;
    const fl_edge g = q->own->p->edge[own];
    const fl_vec3 x0 = q->own->v[g.a], u = v3_sub(q->own->v[g.b], x0);
    const fl_edge_line line = {q->w, q->own, x0, u, q->number[integer_at(r, width, FL_ROW_FACTOR)]};
    if (kind == FL_PAIR_EDGE_FACE) return fl_edge_queue_over_face(&line, t, h0, h1, q->other->n[other]);
    if (kind == FL_PAIR_EDGE_VERTEX)
        return fl_edge_queue_over_point(&line, t, q->other->v[other], NULL, small);
    const fl_edge o = p->edge[other];
    const double length = q->number[integer_at(r, width, FL_ROW_FACTOR + 1)];
    const fl_vec3 a = q->other->v[o.a], e = v3_scale(1.0 / length, v3_sub(q->other->v[o.b], a));
    return fl_edge_queue_over_point(&line, t, a, &e, small);
}

/* True if some part of a face that is within reach of the other lies above a side.  Between a corner within
 * reach and one that is not, g is evaluated at the end of reach.
 *     corner  columns of its n corners
 *     h, g    distances from the plane of the other face and, times sign, from the side */
INLINE int face_above_side(row_pointer r, int width, int32_t corner, int32_t n, double R, const double *h,
                           const double *g, double sign)
{
    int32_t v = integer_at(r, width, corner + n - 1);
    double s = R - h[v], e = sign * g[v];
    for (int32_t c = 0; c < n; c++) {
        v = integer_at(r, width, corner + c);
        const double t = R - h[v], f = sign * g[v];
        if ((t > 0.0 && f > 0.0) || ((t > 0.0) != (s > 0.0) && (s * f - t * e) * (s - t) > 0.0)) return 1;
        s = t, e = f;
    }
    return 0;
}

/* A face has no area over the other if none of its corners is within reach, or if its part within reach is
 * beyond one side. */
INLINE int add_face(const pair_context *q, row_pointer r, int width, int32_t sides)
{
    const int32_t n = integer_at(r, width, FL_ROW_COLUMN), height = integer_at(r, width, FL_ROW_COLUMN + 1);
    const double *h = distances_from(q, height);
    int near = 0;
    for (int32_t c = 0; c < n; c++) near |= h[integer_at(r, width, 5 + sides + c)] < q->R;
    if (!near) return 0;
    for (int32_t k = 0; k < sides; k++) {
        const int32_t side = integer_at(r, width, 5 + k);
        if (!face_above_side(r, width, 5 + sides, n, q->R, h, distances_from(q, side >> 1),
                             side & 1 ? -1.0 : 1.0))
            return 0;
    }
    return fl_face_integral_over_face(q->w, q->own, integer_at(r, width, FL_ROW_OWN), q->other,
                                      integer_at(r, width, FL_ROW_OTHER), q->R, q->prism_depth, q->rim);
}

INLINE int evaluate_all(const pair_context direction[2], const fl_feature_pairs *l, int width)
{
    const size_t each = (size_t)1 << width;
    const char *r = (const char *)fl_feature_pairs_integers(l) + (size_t)fl_feature_pairs_first_row(l) * each;
    for (int32_t k = 0; k < l->n; k++) {
        const row_pointer now = r;
        const int32_t head = integer_at(now, width, FL_ROW_HEAD), n = fl_feature_row_sides(head);
        const int kind = fl_feature_row_kind(head);
        const pair_context *q = &direction[fl_feature_row_direction(head)];
        int bad;
        switch (kind) {
        case FL_PAIR_VERTEX_FACE:
        case FL_PAIR_VERTEX_EDGE:
            r += (size_t)(5 + n) * each, bad = add_vertex(q, now, width, kind, n);
            break;
        case FL_PAIR_VERTEX_VERTEX:
            r += (size_t)(4 + n) * each, bad = add_vertex(q, now, width, kind, n);
            break;
        case FL_PAIR_EDGE_FACE:
        case FL_PAIR_EDGE_EDGE: r += (size_t)(7 + n) * each, bad = queue_edge(q, now, width, kind, n); break;
        case FL_PAIR_EDGE_VERTEX:
            r += (size_t)(6 + n) * each, bad = queue_edge(q, now, width, kind, n);
            break;
        default:
            r += (size_t)(5 + n + integer_at(now, width, FL_ROW_COLUMN)) * each;
            bad = add_face(q, now, width, n);
        }
        if (bad) return -1;
    }
    return 0;
}

/* Evaluates the selected rows. */
INLINE int evaluate_selected(const pair_context direction[2], const fl_feature_pairs *l, int width)
{
    const size_t each = (size_t)1 << width;
    for (int32_t k = 0; k < l->selection->n; k++) {
        const row_pointer r =
            (const char *)fl_feature_pairs_integers(l) + (size_t)l->selection->row_start[k] * each;
        const int32_t head = integer_at(r, width, FL_ROW_HEAD), n = fl_feature_row_sides(head);
        const int kind = fl_feature_row_kind(head);
        const pair_context *q = &direction[fl_feature_row_direction(head)];
        if (kind <= FL_PAIR_VERTEX_VERTEX ? add_vertex(q, r, width, kind, n)
            : kind <= FL_PAIR_EDGE_VERTEX ? queue_edge(q, r, width, kind, n)
                                          : add_face(q, r, width, n))
            return -1;
    }
    return 0;
}

int fl_feature_pairs_evaluate(fl_patch_points *w, const fl_feature_pairs *l, const fl_patch_core *A,
                              const fl_patch_core *B, double R, double prism_depth, double rim_a,
                              double rim_b)
{
    const double *h[2];
    if (l->selection && l->selection->n == 0) return 0;
    const double near = ON_PLANE_TOL * (fabs(w->o.x) + fabs(w->o.y) + fabs(w->o.z) + A->p->size + B->p->size);
    if (fill_table(w, l, 0, A->v, B->p, near, &h[0]) || fill_table(w, l, 1, B->v, A->p, near, &h[1]))
        return -1;
    const double *number = fl_feature_pairs_numbers(l);
    const pair_context direction[2] = {
        {w, number, A, B, h[0], (size_t)fl_feature_columns(l->vertices[0]), R, prism_depth, rim_b},
        {w, number, B, A, h[1], (size_t)fl_feature_columns(l->vertices[1]), R, prism_depth, rim_a}};
    if (fl_edge_integral_begin(w)) return -1;
    const int bad = l->selection    ? l->width == 0   ? evaluate_selected(direction, l, 0)
                                      : l->width == 1 ? evaluate_selected(direction, l, 1)
                                                      : evaluate_selected(direction, l, 2)
                       : l->width == 0 ? evaluate_all(direction, l, 0)
                    : l->width == 1 ? evaluate_all(direction, l, 1)
                                    : evaluate_all(direction, l, 2);
    return bad || fl_edge_integral_finish(w, R) ? -1 : 0;
}
