/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "patch/feature_filter.h"
#include "base/array.h"
#include "base/simd.h"
#include "patch/edge_integral.h"

#define INLINE static inline __attribute__((always_inline))

/* Half-space g.x >= c, the margin included in c. */
typedef struct fl_filter_plane {
    fl_vec3 g;
    double c, size; /* |g| */
} filter_plane;

/* Region of a feature of the other core: half-spaces, and for an edge or a vertex the line along `axis`
 * through `from`, or the point, within reach of which it extends.  axis of a face: its normal. */
typedef struct {
    int32_t planes, sides; /* the last of the planes are side planes */
    int line;
    fl_vec3 from, axis;
} region;

/* Appends own vertex v to the corners, of which there are *corners, and to the vertices, of which there are
 * *n; there is memory for both.  An entry of `at` from an earlier call is detected and overwritten. */
INLINE void append_corner(const fl_feature_filter *w, int32_t *corners, int32_t *n, int32_t v)
{
    int32_t k = w->at[v];
    if (k >= *n || w->vertex[k] != v) k = w->at[v] = *n, w->vertex[(*n)++] = v;
    w->corner[(*corners)++] = k;
}

static int32_t count_features(const fl_feature_set *mine)
{
    return mine->vertices + mine->edges + mine->faces;
}

/* Lists the corners of the own features and loads their vertices.  Returns the number of vertices, or -1. */
static int32_t load_own_features(fl_feature_filter *w, const fl_feature_query *s, const fl_feature_set *mine)
{
    const fl_poly *p = s->own->p;
    const int32_t known = w->at_cap;
    int64_t most = mine->vertices + 2 * (int64_t)mine->edges;
    int32_t n = 0, corners = 0, k = 0;
    for (int32_t m = 0; m < mine->faces; m++) most += p->first[mine->face[m] + 1] - p->first[mine->face[m]];
    if (fl_reserve(&w->corner, &w->corner_cap, most, sizeof *w->corner) ||
        fl_reserve(&w->vertex, &w->vertex_cap, most < p->nv ? most : p->nv, sizeof *w->vertex) ||
        fl_reserve(&w->at, &w->at_cap, p->nv, sizeof *w->at) ||
        fl_reserve(&w->first, &w->first_cap, (int64_t)count_features(mine) + 1, sizeof *w->first))
        return -1;
    memset(w->at + known, 0, (size_t)(w->at_cap - known) * sizeof *w->at);
    for (int32_t m = 0; m < mine->vertices; m++) {
        w->first[k++] = corners;
        append_corner(w, &corners, &n, mine->vertex[m]);
    }
    for (int32_t m = 0; m < mine->edges; m++) {
        const fl_edge e = p->edge[mine->edge[m]];
        w->first[k++] = corners;
        append_corner(w, &corners, &n, e.a), append_corner(w, &corners, &n, e.b);
    }
    for (int32_t m = 0; m < mine->faces; m++) {
        w->first[k++] = corners;
        for (int32_t c = p->first[mine->face[m]]; c < p->first[mine->face[m] + 1]; c++)
            append_corner(w, &corners, &n, p->loop[c]);
    }
    w->first[k] = corners;
    const int32_t wide = (n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH;
    if (fl_reserve(&w->x, &w->x_cap, 3 * (int64_t)wide, sizeof *w->x)) return -1;
    for (int32_t v = 0; v < wide; v++) {
        const fl_vec3 x = s->own->v[w->vertex[v < n ? v : n - 1]];
        w->x[v] = x.x, w->x[wide + v] = x.y, w->x[2 * wide + v] = x.z;
    }
    if (s->side_margin < 0.0) return n;
    if (fl_reserve(&w->room, &w->room_cap, n, sizeof *w->room)) return -1;
    for (int32_t v = 0; v < n; v++) {
        const double far2 = v3_norm2(v3_sub(s->own->v[w->vertex[v]], s->centre)),
                     near2 = s->margin_radius * s->margin_radius;
        w->room[v] = s->margin + (far2 > near2 ? sqrt(far2 / near2) * s->side_margin : s->side_margin);
    }
    return n;
}

/* Distances of all vertices from all planes, and the least of each vertex.  Returns 0 where some plane has no
 * vertex above it. */
FL_SIMD_VERSIONS static int tabulate_distances(const filter_plane *b, int32_t planes, const double *x,
                                               int32_t wide, double *h, double *least)
{
    for (int32_t k = 0; k < planes; k++, b++) {
        fl_simd_mask some = {0, 0, 0, 0};
        for (int32_t v = 0; v < wide; v += FL_SIMD_WIDTH, h += FL_SIMD_WIDTH) {
            const fl_simd now = b->g.x * FL_SIMD_LOAD(&x[v]) + b->g.y * FL_SIMD_LOAD(&x[wide + v]) +
                                b->g.z * FL_SIMD_LOAD(&x[2 * wide + v]) - b->c;
            const fl_simd low = k == 0 ? now : FL_SIMD_LOAD(&least[v]);
            FL_SIMD_STORE(h) = now;
            FL_SIMD_STORE(&least[v]) = FL_SIMD_SELECT(now < low, now, low);
            some |= now >= 0.0;
        }
        if (!(some[0] | some[1] | some[2] | some[3])) return 0;
    }
    return 1;
}

INLINE void append_plane(filter_plane **b, const fl_feature_query *s, fl_vec3 from, fl_vec3 g)
{
    const double size = v3_norm(g);
    *(*b)++ = (filter_plane){g, v3_dot(g, from) - s->margin * size, size};
}

INLINE fl_vec3 side_normal(const fl_patch_core *q, int32_t f, int32_t a, int32_t b)
{
    return v3_cross(q->n[f], v3_sub(q->v[b], q->v[a]));
}

/* Points below a face by at most s->prism_depth may belong to it beyond a concave side, up to the bisector of
 * the two faces: they are inclined by 60 degrees at most, the bisector by half of it; tan 30 deg. */
#define CONCAVE_SHIFT 0.57735026918962576

static region region_of_face(filter_plane *to, const fl_feature_query *s, int32_t f)
{
    const fl_patch_core *q = s->other;
    const int32_t *loop = q->p->loop + q->p->first[f], sides = q->p->first[f + 1] - q->p->first[f];
    const fl_vec3 n = q->n[f], from = q->v[loop[0]];
    filter_plane *b = to;
    append_plane(&b, s, v3_madd(from, s->R, n), v3_neg(n));
    append_plane(&b, s, v3_madd(from, -s->prism_depth, n), n);
    for (int32_t c = 0, last = sides - 1; c < sides; last = c++) {
        const fl_vec3 g = side_normal(q, f, loop[last], loop[c]);
        const int concave = q->p->concave_face && q->p->concave_face[q->p->first[f] + last] >= 0;
        append_plane(&b, s,
                     concave ? v3_madd(q->v[loop[last]], -CONCAVE_SHIFT * s->prism_depth, v3_unit(g))
                             : q->v[loop[last]],
                     g);
    }
    return (region){sides + 2, sides, 0, from, n};
}

static region region_of_edge(filter_plane *to, const fl_feature_query *s, int32_t e)
{
    const fl_patch_core *q = s->other;
    const fl_edge g = q->p->edge[e];
    const fl_vec3 a = q->v[g.a], b = q->v[g.b], u = v3_sub(b, a);
    filter_plane *t = to;
    append_plane(&t, s, a, u);
    append_plane(&t, s, b, v3_neg(u));
    if (g.left >= 0) append_plane(&t, s, a, v3_neg(side_normal(q, g.left, g.a, g.b)));
    if (g.right >= 0) append_plane(&t, s, a, side_normal(q, g.right, g.a, g.b));
    return (region){(int32_t)(t - to), (int32_t)(t - to), 1, a, u};
}

static region region_of_vertex(filter_plane *to, const fl_feature_query *s, int32_t v)
{
    const fl_poly *p = s->other->p;
    const fl_vec3 c = s->other->v[v];
    filter_plane *b = to;
    for (int32_t m = p->neighbour_first[v]; m < p->neighbour_first[v + 1]; m++)
        append_plane(&b, s, c, v3_sub(c, s->other->v[p->neighbour[m]]));
    return (region){(int32_t)(b - to), (int32_t)(b - to), 1, c, v3(0, 0, 0)};
}

/* True if the clipped edge, or the vertex, comes within reach of the line or the point. */
INLINE int within_reach(const fl_feature_query *s, const region *t, fl_vec3 x, fl_vec3 end, fl_edge_span left)
{
    const fl_vec3 u = t->axis, way = v3_sub(end, x);
    const double uu = v3_norm2(u), each = uu > 0.0 ? 1.0 / uu : 0.0, far = s->R + s->margin;
    const fl_vec3 r = v3_sub(x, t->from), q = v3_madd(r, -each * v3_dot(r, u), u),
                  w = v3_madd(way, -each * v3_dot(way, u), u);
    const double ww = v3_norm2(w), to = ww > 0.0 ? -v3_dot(q, w) / ww : 0.0;
    const double at = to < left.lo ? left.lo : to > left.hi ? left.hi : to;
    return v3_norm2(v3_madd(q, at, w)) < far * far;
}

/* Clips the edge from corner a to b by all planes.  Returns 0 where nothing is left. */
static int clip_edge(const double *h, int32_t planes, int32_t wide, int32_t a, int32_t b, fl_edge_span *left)
{
    *left = (fl_edge_span){0.0, 1.0};
    for (int32_t k = 0; k < planes; k++, h += wide)
        if (!fl_edge_span_clip(left, h[a], h[b])) return 0;
    return 1;
}

/* True if each plane has a corner above it. */
static int face_may_reach(const double *h, int32_t planes, int32_t wide, const int32_t *corner, int32_t n)
{
    for (int32_t k = 0; k < planes; k++, h += wide) {
        int32_t c = 0;
        while (c < n && !(h[corner[c]] >= 0.0)) c++;
        if (c == n) return 0;
    }
    return 1;
}

/* A hit, with the side planes marked that all n corners clear. */
INLINE uint32_t mark_redundant_sides(const fl_feature_filter *w, const fl_feature_query *s, const region *t,
                                     const double *h, int32_t wide, const int32_t *corner, int32_t n)
{
    uint32_t hit = 1;
    if (s->side_margin < 0.0) return hit;
    const int32_t from = t->planes - t->sides, sides = t->sides < 31 ? t->sides : 31;
    const filter_plane *b = w->plane + from;
    h += (int64_t)from * wide;
    for (int32_t k = 0; k < sides; k++, b++, h += wide) {
        int32_t c = 0;
        while (c < n && h[corner[c]] > b->size * w->room[corner[c]]) c++;
        if (c == n) hit |= 2u << k;
    }
    return hit;
}

/* Fills column k of the hits: own vertices, edges and, where the region is that of a face, own faces. */
static void test_column(fl_feature_filter *w, const fl_feature_query *s, const fl_feature_set *mine,
                        const region *t, int32_t k, int32_t n)
{
    const int32_t wide = (n + FL_SIMD_WIDTH - 1) / FL_SIMD_WIDTH * FL_SIMD_WIDTH, m = t->planes;
    const fl_vec3 *x = s->own->v;
    uint32_t *hit = w->hit + k;
    double *h = w->h, *least = h + (int64_t)m * wide;
    const int32_t *c = w->corner, *first = w->first + mine->vertices + mine->edges;
    fl_edge_span left;
    if (!tabulate_distances(w->plane, m, w->x, wide, h, least)) return;
    for (int32_t o = 0; o < mine->vertices; o++, c++, hit += w->others)
        if (least[*c] >= 0.0 &&
            (!t->line || within_reach(s, t, x[w->vertex[*c]], x[w->vertex[*c]], (fl_edge_span){0.0, 1.0})))
            *hit = mark_redundant_sides(w, s, t, h, wide, c, 1);
    for (int32_t o = 0; o < mine->edges; o++, c += 2, hit += w->others)
        if (clip_edge(h, m, wide, c[0], c[1], &left) &&
            (!t->line || within_reach(s, t, x[w->vertex[c[0]]], x[w->vertex[c[1]]], left)))
            *hit = mark_redundant_sides(w, s, t, h, wide, c, 2);
    for (int32_t o = 0; o < mine->faces && !t->line; o++, first++, hit += w->others)
        if (v3_dot(s->own->n[mine->face[o]], t->axis) <= s->max_cosine &&
            face_may_reach(h, m, wide, w->corner + first[0], first[1] - first[0]))
            *hit = mark_redundant_sides(w, s, t, h, wide, w->corner + first[0], first[1] - first[0]);
}

/* Reserves memory for the planes of one region. */
INLINE int reserve_planes(fl_feature_filter *w, int32_t n, int64_t planes)
{
    return fl_reserve(&w->plane, &w->plane_cap, planes, sizeof *w->plane) ||
           fl_reserve(&w->h, &w->h_cap, (planes + 1) * (n + FL_SIMD_WIDTH), sizeof *w->h);
}

int fl_feature_filter_find(fl_feature_filter *w, const fl_feature_query *s, const fl_feature_set *mine,
                           const fl_feature_set *near)
{
    const fl_poly *p = s->other->p;
    const int32_t owns = count_features(mine);
    int32_t k = 0;
    w->others = near->faces + near->edges + near->vertices;
    const int64_t hits = (int64_t)owns * w->others;
    /* at least one entry, also for none */
    if (fl_reserve(&w->hit, &w->hit_cap, hits + 1, sizeof *w->hit)) return -1;
    if (hits == 0) return 0;
    const int32_t n = load_own_features(w, s, mine);
    if (n < 0) return -1;
    memset(w->hit, 0, (size_t)hits * sizeof *w->hit);
    for (int32_t m = 0; m < near->faces; m++, k++) {
        const int32_t f = near->face[m];
        if (reserve_planes(w, n, 2 + (int64_t)p->first[f + 1] - p->first[f])) return -1;
        const region t = region_of_face(w->plane, s, f);
        test_column(w, s, mine, &t, k, n);
    }
    for (int32_t m = 0; m < near->edges; m++, k++) {
        if (!(fl_poly_edge_angle(p, near->edge[m]) > 0.0)) continue;
        if (reserve_planes(w, n, 4)) return -1;
        const region t = region_of_edge(w->plane, s, near->edge[m]);
        test_column(w, s, mine, &t, k, n);
    }
    for (int32_t m = 0; m < near->vertices; m++, k++) {
        const int32_t v = near->vertex[m];
        if (!(fl_poly_corner_angle(p, v) > 0.0)) continue;
        if (reserve_planes(w, n, p->neighbour_first[v + 1] - p->neighbour_first[v])) return -1;
        const region t = region_of_vertex(w->plane, s, v);
        test_column(w, s, mine, &t, k, n);
    }
    return 0;
}

void fl_feature_filter_free(fl_feature_filter *w)
{
    free(w->hit), free(w->vertex), free(w->at), free(w->corner), free(w->first), free(w->x), free(w->h);
    free(w->room), free(w->plane);
    *w = (fl_feature_filter){0};
}
