/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/plane_distances.h"
#include <math.h>
#include <stddef.h>
#include "base/array.h"
#include "base/simd.h"
#include "patch/edge_integral.h"
#include "patch/face_integral.h"
#include "patch/patch_law.h"

/* Of how far things are and how large: what rounding makes of a distance from a plane. */
#define NEAR 4e-15

/* Rows of heights, all or those in the list, `columns` each, a multiple of FL_SIMD_WIDTH, of points x, y, z.  What
 * lies on a plane is taken as a hair aside, for all who ask to the same side; on it is what is nearer to it
 * than |g| near, since planes that are one are rounded one by one: on which side of them a point lies that is
 * on all of them must not hang on that. */
FL_SIMD_VERSIONS static void heights(const fl_core_plane *cut, const int32_t *list, int32_t rows,
                                     const double *x, const double *y, const double *z, int32_t columns,
                                     double near, double *h)
{
    for (int32_t c = 0; c < rows; c++) {
        const int32_t k = list ? list[c] : c;
        const fl_core_plane p = cut[k];
        const double hair = fl_plane_tie_offset(p.g);
        const double on = near * (fabs(p.g.x) + fabs(p.g.y) + fabs(p.g.z));
        for (int32_t v = 0; v < columns; v += FL_SIMD_WIDTH) {
            const fl_simd X = *(const fl_simd *)(x + v), Y = *(const fl_simd *)(y + v);
            const fl_simd Z = *(const fl_simd *)(z + v), up = p.g.x * X + p.g.y * Y + p.g.z * Z - p.c;
            *(fl_simd *)(h + (int64_t)k * columns + v) = FL_SIMD_MASKED((up > on) | (up < -on), up) + hair;
        }
    }
}

#define INLINE static inline __attribute__((always_inline))

/* Vertices by their numbers, which begin with the one that is `from`: x, y and z one after the other, to full
 * registers. */
INLINE void gather(const fl_vec3 *v, const void *whole, int wide, int32_t from, int32_t n, int32_t columns,
                   double *x)
{
    for (int32_t k = 0; k < columns; k++, x++) {
        const fl_vec3 *const r = &v[fl_feature_integer(whole, wide, from + (k < n ? k : n - 1))];
        x[0] = r->x, x[columns] = r->y, x[2 * columns] = r->z;
    }
}

/* Points turned back from M r + o. */
FL_SIMD_VERSIONS static void turn_back(double *x, int32_t columns, const fl_mat3 *M, fl_vec3 o)
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

/* way 0: vertices of A as they are, entered, over planes of B; 1: those of B, in the frame of A, over planes
 * of A. */
static int fill(fl_patch_points *w, const fl_feature_pairs *l, int way, const fl_vec3 *own,
                const fl_poly *other, double near, const double **out)
{
    fl_distance_table *s = &w->distances[way];
    const int32_t vertices = l->vertices[way], from = way ? l->vertices[0] : 0, cuts = l->planes[way];
    const int32_t columns = fl_feature_columns(vertices);
    const void *whole = fl_feature_pairs_integers(l);
    const int wide = l->width;
    if (fl_reserve(&s->x, &s->x_cap, 3 * (int64_t)columns, sizeof *s->x) ||
        fl_reserve(&s->h, &s->h_cap, (int64_t)cuts * (columns + 4), sizeof *s->h))
        return -1;
    double *const x = s->x, *const y = x + columns, *const z = y + columns;
    if (wide == 0) gather(own, whole, 0, from, vertices, columns, x);
    else gather(own, whole, wide, from, vertices, columns, x);
    if (way) turn_back(x, columns, &w->M, w->o);
    const int32_t *list = l->selection ? l->selection->plane[way] : NULL;
    fl_core_plane *const made = (fl_core_plane *)(void *)(s->h + (int64_t)cuts * columns);
    if (!l->stores_planes) fl_feature_pairs_make_planes(l, way, other, made);
    heights(l->stores_planes ? fl_feature_pairs_planes(l, way) : made, list,
            list ? l->selection->planes[way] : cuts, x, y, z, columns, l->stores_planes ? 0.0 : near, s->h);
    *out = s->h;
    return 0;
}

/* Everything that a match needs. */
typedef struct {
    fl_patch_points *w;
    const double *number;
    const fl_patch_core *own, *other;
    const double *h; /* of this way, */
    size_t columns;  /* so many a row */
    double R, behind, rim;
} meeting;

/* A row of the list, in work. */
typedef const void *row;

INLINE int32_t get(row r, int wide, int32_t k) { return fl_feature_integer(r, wide, k); }

/* Heights over plane k. */
INLINE const double *row_of(const meeting *q, int32_t k) { return q->h + (uint32_t)k * q->columns; }

/* A vertex lies beyond all n sides, which begin behind the first fixed numbers. */
INLINE int beyond_all(const meeting *q, row r, int wide, int fixed, int32_t n, int32_t v)
{
    for (int32_t k = 0; k < n; k++) {
        const int32_t side = get(r, wide, fixed + k);
        const double h = row_of(q, side >> 1)[v];
        if (side & 1 ? h > 0.0 : h < 0.0) return 0;
    }
    return 1;
}

/* Keep of an edge what lies beyond all the sides. */
INLINE int keep_beyond(const meeting *q, row r, int wide, int fixed, int32_t n, int32_t v0, int32_t v1,
                       fl_edge_span *t)
{
    for (int32_t k = 0; k < n; k++) {
        const int32_t side = get(r, wide, fixed + k);
        const double *h = row_of(q, side >> 1), h0 = h[v0], h1 = h[v1];
        if (!(side & 1 ? fl_edge_span_clip(t, -h0, -h1) : fl_edge_span_clip(t, h0, h1))) return 0;
    }
    return 1;
}

/* Vertex v at r from the nearest point of an edge or a vertex. */
static int vertex_at(const meeting *q, int32_t v, fl_vec3 r)
{
    const double d = v3_norm(r);
    if (d >= q->R || d <= FL_SAME_POINT_TOL * q->other->p->size) return 0;
    return fl_patch_points_add_vertex(q->w, q->own, q->other->r, v, v3_scale(1.0 / d, r), q->R - d);
}

INLINE int vertex(const meeting *q, row r, int wide, int kind, int32_t n)
{
    const fl_poly *p = q->other->p;
    const int32_t own = get(r, wide, FL_ROW_OWN), other = get(r, wide, FL_ROW_OTHER),
                  v = get(r, wide, FL_ROW_COLUMN);
    if (kind == FL_PAIR_VERTEX_FACE) {
        const double h = row_of(q, get(r, wide, FL_ROW_COLUMN + 1))[v];
        if (h >= q->R || h < -FL_SAME_POINT_TOL * p->size || !beyond_all(q, r, wide, 5, n, v)) return 0;
        return fl_patch_points_add_vertex(q->w, q->own, q->other->r, own, q->other->n[other], q->R - h);
    }
    if (!beyond_all(q, r, wide, kind == FL_PAIR_VERTEX_VERTEX ? 4 : 5, n, v)) return 0;
    if (kind == FL_PAIR_VERTEX_VERTEX) return vertex_at(q, own, v3_sub(q->own->v[own], q->other->v[other]));
    const fl_edge g = p->edge[other];
    const double length = q->number[get(r, wide, FL_ROW_COLUMN + 1)];
    const fl_vec3 a = q->other->v[g.a], e = v3_scale(1.0 / length, v3_sub(q->other->v[g.b], a));
    const fl_vec3 way = v3_sub(q->own->v[own], a);
    return vertex_at(q, own, v3_madd(way, -v3_dot(way, e), e));
}

INLINE int edge(const meeting *q, row r, int wide, int kind, int32_t n)
{
    const fl_poly *p = q->other->p;
    const int32_t own = get(r, wide, FL_ROW_OWN), other = get(r, wide, FL_ROW_OTHER),
                  v0 = get(r, wide, FL_ROW_COLUMN), v1 = get(r, wide, FL_ROW_SECOND_COLUMN);
    const double small = FL_SAME_POINT_TOL * p->size;
    double h0 = 0.0, h1 = 0.0;
    fl_edge_span t = {0.0, 1.0};
    if (kind == FL_PAIR_EDGE_FACE) {
        const double *h = row_of(q, get(r, wide, FL_ROW_FACTOR + 1)), below = q->behind + small;
        h0 = h[v0], h1 = h[v1];
        if ((h0 >= q->R && h1 >= q->R) || !fl_edge_span_clip(&t, h0 + below, h1 + below)) return 0;
    }
    if (!keep_beyond(q, r, wide, kind == FL_PAIR_EDGE_VERTEX ? 6 : 7, n, v0, v1, &t)) return 0;
    const fl_edge g = q->own->p->edge[own];
    const fl_vec3 x0 = q->own->v[g.a], u = v3_sub(q->own->v[g.b], x0);
    const fl_edge_line line = {q->w, q->own, x0, u, q->number[get(r, wide, FL_ROW_FACTOR)]};
    if (kind == FL_PAIR_EDGE_FACE) return fl_edge_queue_over_face(&line, t, h0, h1, q->other->n[other]);
    if (kind == FL_PAIR_EDGE_VERTEX)
        return fl_edge_queue_over_point(&line, t, q->other->v[other], NULL, small);
    const fl_edge o = p->edge[other];
    const double length = q->number[get(r, wide, FL_ROW_FACTOR + 1)];
    const fl_vec3 a = q->other->v[o.a], e = v3_scale(1.0 / length, v3_sub(q->other->v[o.b], a));
    return fl_edge_queue_over_point(&line, t, a, &e, small);
}

/* Whether anything of a face that is within reach of the other lies above a side.  corner: columns of its n
 * corners; h, g: heights over the other and, times sign, over the side.  Between a corner in reach and one
 * that is not, g is looked at where reach ends. */
INLINE int above_side(row r, int wide, int32_t corner, int32_t n, double R, const double *h, const double *g,
                      double sign)
{
    int32_t v = get(r, wide, corner + n - 1);
    double s = R - h[v], e = sign * g[v];
    for (int32_t c = 0; c < n; c++) {
        v = get(r, wide, corner + c);
        const double t = R - h[v], f = sign * g[v];
        if ((t > 0.0 && f > 0.0) || ((t > 0.0) != (s > 0.0) && (s * f - t * e) * (s - t) > 0.0)) return 1;
        s = t, e = f;
    }
    return 0;
}

/* A face none of whose corners is within reach and above the other, or what of it is within reach is all
 * beyond one of its sides, has no area there. */
INLINE int face(const meeting *q, row r, int wide, int32_t sides)
{
    const int32_t n = get(r, wide, FL_ROW_COLUMN), height = get(r, wide, FL_ROW_COLUMN + 1);
    const double *h = row_of(q, height);
    int near = 0;
    for (int32_t c = 0; c < n; c++) near |= h[get(r, wide, 5 + sides + c)] < q->R;
    if (!near) return 0;
    for (int32_t k = 0; k < sides; k++) {
        const int32_t side = get(r, wide, 5 + k);
        if (!above_side(r, wide, 5 + sides, n, q->R, h, row_of(q, side >> 1), side & 1 ? -1.0 : 1.0))
            return 0;
    }
    return fl_face_integral_over_face(q->w, q->own, get(r, wide, FL_ROW_OWN), q->other,
                                      get(r, wide, FL_ROW_OTHER), q->R, q->behind, q->rim);
}

INLINE int all_rows(const meeting way[2], const fl_feature_pairs *l, int wide)
{
    const size_t each = (size_t)1 << wide;
    const char *r = (const char *)fl_feature_pairs_integers(l) + (size_t)fl_feature_pairs_first_row(l) * each;
    for (int32_t k = 0; k < l->n; k++) {
        const row now = r;
        const int32_t head = get(now, wide, FL_ROW_HEAD), n = fl_feature_row_sides(head);
        const int kind = fl_feature_row_kind(head);
        const meeting *q = &way[fl_feature_row_direction(head)];
        int bad;
        switch (kind) {
        case FL_PAIR_VERTEX_FACE:
        case FL_PAIR_VERTEX_EDGE: r += (size_t)(5 + n) * each, bad = vertex(q, now, wide, kind, n); break;
        case FL_PAIR_VERTEX_VERTEX: r += (size_t)(4 + n) * each, bad = vertex(q, now, wide, kind, n); break;
        case FL_PAIR_EDGE_FACE:
        case FL_PAIR_EDGE_EDGE: r += (size_t)(7 + n) * each, bad = edge(q, now, wide, kind, n); break;
        case FL_PAIR_EDGE_VERTEX: r += (size_t)(6 + n) * each, bad = edge(q, now, wide, kind, n); break;
        default: r += (size_t)(5 + n + get(now, wide, FL_ROW_COLUMN)) * each; bad = face(q, now, wide, n);
        }
        if (bad) return -1;
    }
    return 0;
}

/* Those that the caller has chosen. */
INLINE int some_rows(const meeting way[2], const fl_feature_pairs *l, int wide)
{
    const size_t each = (size_t)1 << wide;
    for (int32_t k = 0; k < l->selection->n; k++) {
        const row r = (const char *)fl_feature_pairs_integers(l) + (size_t)l->selection->row_start[k] * each;
        const int32_t head = get(r, wide, FL_ROW_HEAD), n = fl_feature_row_sides(head);
        const int kind = fl_feature_row_kind(head);
        const meeting *q = &way[fl_feature_row_direction(head)];
        if (kind <= FL_PAIR_VERTEX_VERTEX ? vertex(q, r, wide, kind, n)
            : kind <= FL_PAIR_EDGE_VERTEX ? edge(q, r, wide, kind, n)
                                          : face(q, r, wide, n))
            return -1;
    }
    return 0;
}

int fl_feature_pairs_evaluate(fl_patch_points *w, const fl_feature_pairs *l, const fl_patch_core *A,
                              const fl_patch_core *B, double R, double behind, double rim_a, double rim_b)
{
    const double *h[2];
    if (l->selection && l->selection->n == 0) return 0;
    const double near = NEAR * (fabs(w->o.x) + fabs(w->o.y) + fabs(w->o.z) + A->p->size + B->p->size);
    if (fill(w, l, 0, A->v, B->p, near, &h[0]) || fill(w, l, 1, B->v, A->p, near, &h[1])) return -1;
    const double *number = fl_feature_pairs_numbers(l);
    const meeting way[2] = {
        {w, number, A, B, h[0], (size_t)fl_feature_columns(l->vertices[0]), R, behind, rim_b},
        {w, number, B, A, h[1], (size_t)fl_feature_columns(l->vertices[1]), R, behind, rim_a}};
    if (fl_edge_integral_begin(w)) return -1;
    const int bad = l->selection    ? l->width == 0   ? some_rows(way, l, 0)
                                      : l->width == 1 ? some_rows(way, l, 1)
                                                      : some_rows(way, l, 2)
                       : l->width == 0 ? all_rows(way, l, 0)
                    : l->width == 1 ? all_rows(way, l, 1)
                                    : all_rows(way, l, 2);
    return bad || fl_edge_integral_finish(w, R) ? -1 : 0;
}
