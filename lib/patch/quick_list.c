/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/quick_list.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/simd.h"
#include "geom/quadrature_rules.h"

/* Multiples of R for the margin: of the first list, and bounds. */
#define FIRST_MARGIN 0.05
#define MIN_MARGIN 0.01
#define MAX_MARGIN 0.25
#define BUILD_COST 10.0 /* evaluations that building a list takes */
#define FACING 0.866    /* cosine below that of 30 degrees: faces at a larger angle have no term */
#define LENGTH_TOL 1e-12

/* One direction: the own core over the other. */
typedef struct {
    const fl_quick_shape *own, *other;
    fl_mat3 M; /* from the frame of own to that of other */
    fl_vec3 o;
    double rho, R, margin;
    fl_vec3 *at;    /* [own->vertices] in the frame of other */
    double *height; /* [own->vertices * other->planes] */
    double *lowest; /* [own->vertices] lower bound of the distance from the other core */
    double *flags;  /* [other->planes] scratch */
    uint8_t *near;  /* [own->edges] near the other core, and [other->edges] near the own one: */
    const uint8_t *other_near;
} direction;

static int append_index(fl_quick_list *l, int32_t k)
{
    if (l->n == l->cap && fl_reserve(&l->index, &l->cap, (int64_t)l->n + 1, sizeof *l->index)) return -1;
    l->index[l->n++] = k;
    return 0;
}

/* Distance of a point from a segment, and of two segments. */
static double point_from_edge(fl_vec3 x, const fl_quick_edge *e)
{
    const fl_vec3 w = v3_sub(x, e->a);
    const double t = v3_dot(w, e->d), u = t < 0.0 ? 0.0 : t > e->length ? e->length : t;
    return v3_norm(v3_madd(w, -u, e->d));
}

static double edge_from_edge(const fl_quick_edge *e, const fl_quick_edge *f)
{
    const double C = v3_dot(e->d, f->d), S2 = 1.0 - C * C;
    const fl_vec3 w = v3_sub(e->a, f->a);
    if (S2 > LENGTH_TOL) {
        const double wa = v3_dot(w, e->d), wb = v3_dot(w, f->d), t = (C * wb - wa) / S2,
                     u = (wb - C * wa) / S2;
        if (t >= 0.0 && t <= e->length && u >= 0.0 && u <= f->length)
            return v3_norm(v3_madd(v3_madd(w, t, e->d), -u, f->d));
    }
    return fmin(fmin(point_from_edge(e->a, f), point_from_edge(v3_madd(e->a, e->length, e->d), f)),
                fmin(point_from_edge(f->a, e), point_from_edge(v3_madd(f->a, f->length, f->d), e)));
}

/* Edge e of the own core in the frame of the other. */
static fl_quick_edge moved_edge(const direction *d, int32_t e)
{
    fl_quick_edge to = d->own->edge[e];
    to.a = d->at[to.end[0]], to.d = m3_mul(d->M, to.d);
    return to;
}

/* The largest lane. */
FL_SIMD_INLINE double largest_of(const fl_simd *v)
{
    double most = (*v)[0];
    FL_SIMD_UNROLL
    for (int k = 1; k < FL_SIMD_WIDTH; k++) most = (*v)[k] > most ? (*v)[k] : most;
    return most;
}

/* Lower bound of the distance of the part from t to u of an edge from the other core. */
FL_SIMD_INLINE double least_distance(const direction *d, const int32_t *end, double t, double u)
{
    const int32_t planes = d->other->planes;
    const double *a = d->height + end[0] * planes, *b = d->height + end[1] * planes;
    fl_simd most = FL_SIMD_SPLAT(-INFINITY);
    for (int32_t f = 0; f < planes; f += FL_SIMD_WIDTH) {
        const fl_simd from = FL_SIMD_LOAD(a + f), rise = FL_SIMD_LOAD(b + f) - from, zero = {0},
                      h = from + rise * FL_SIMD_SELECT(rise > zero, t + zero, u + zero);
        most = FL_SIMD_SELECT(h > most, h, most);
    }
    return largest_of(&most);
}

/* Vertices and edges of the own core over the planes of the other. */
FL_SIMD_VERSIONS static void measure_heights(const direction *d)
{
    const int32_t planes = d->other->planes;
    double *const *plane = d->other->plane;
    const double near = d->R + d->margin;
    for (int32_t v = 0; v < d->own->vertices; v++) {
        const fl_vec3 x = d->at[v] = v3_add(m3_mul(d->M, d->own->vertex[v]), d->o);
        double *const to = d->height + v * planes;
        fl_simd most = FL_SIMD_SPLAT(-INFINITY);
        for (int32_t f = 0; f < planes; f += FL_SIMD_WIDTH) {
            const fl_simd h = FL_SIMD_LOAD(plane[0] + f) * x.x + FL_SIMD_LOAD(plane[1] + f) * x.y +
                              FL_SIMD_LOAD(plane[2] + f) * x.z - FL_SIMD_LOAD(plane[3] + f);
            FL_SIMD_STORE(to + f) = h;
            most = FL_SIMD_SELECT(h > most, h, most);
        }
        d->lowest[v] = largest_of(&most);
    }
    for (int32_t e = 0; e < d->own->edges; e++) {
        const int32_t *end = d->own->edge[e].end;
        d->near[e] = d->lowest[end[0]] <= near || d->lowest[end[1]] <= near ||
                     least_distance(d, end, 0.0, 1.0) <= near;
    }
}

FL_SIMD_VERSIONS static int part_is_near(const direction *d, const int32_t *end, double t, double u)
{
    return least_distance(d, end, t, u) <= d->R + d->margin;
}

static int append_points(fl_quick_list *l, direction *d, int section)
{
    const double near = d->R + d->margin;
    l->first[section] = l->n;
    for (int32_t v = 0; v < d->own->vertices; v++)
        if (d->own->weight[v] > 0.0 && d->lowest[v] <= near && append_index(l, v)) return -1;
    l->first[section + 1] = l->n;
    for (int32_t e = 0; e < d->own->edges; e++) {
        const fl_quick_edge *edge = &d->own->edge[e];
        if (!d->near[e] || !(edge->weight > 0.0)) continue;
        const int32_t n = fl_quick_segments(edge, d->rho);
        for (int32_t k = 0; k < n; k++)
            if (part_is_near(d, edge->end, (k + FL_LINE4_NODE[0]) / n,
                             (k + FL_LINE4_NODE[FL_LINE4_NODES - 1]) / n) &&
                (append_index(l, e) || append_index(l, k) || append_index(l, n)))
                return -1;
    }
    l->first[section + 2] = l->n;
    return 0;
}

/* True if all corners of a face lie beyond one of the sides of another by more than the margin. */
static int is_beside(const fl_quick_shape *s, int32_t f, const fl_vec3 *at, const int32_t *loop, int32_t n,
                     double margin)
{
    const fl_quick_face *face = &s->face[f];
    for (int32_t k = 0; k < face->sides; k++) {
        const fl_quick_side *side = &s->side[face->first + k];
        int beyond = 1;
        for (int32_t c = 0; c < n && beyond; c++) beyond = v3_dot(side->q, at[loop[c]]) - side->c > margin;
        if (beyond) return 1;
    }
    return 0;
}

/* Cosines of a normal n against those of the other core, negative, into flags. */
FL_SIMD_VERSIONS static void find_facing(const direction *d, fl_vec3 n)
{
    double *const *plane = d->other->plane;
    for (int32_t f = 0; f < d->other->planes; f += FL_SIMD_WIDTH)
        FL_SIMD_STORE(d->flags + f) = -(FL_SIMD_LOAD(plane[0] + f) * n.x + FL_SIMD_LOAD(plane[1] + f) * n.y +
                                        FL_SIMD_LOAD(plane[2] + f) * n.z);
}

static int append_faces(fl_quick_list *l, const direction *d, int section)
{
    const fl_quick_shape *own = d->own, *other = d->other;
    const double tilt = FACING - d->margin / (own->bound + d->R);
    for (int32_t j = 0; j < own->faces; j++) {
        const int32_t *loop = own->loop + own->face[j].first, sides = own->face[j].sides;
        find_facing(d, m3_mul(d->M, own->face[j].n));
        for (int32_t k = 0; k < other->faces; k++) {
            double low = INFINITY, high = -INFINITY;
            if (d->flags[k] < tilt) continue;
            for (int32_t c = 0; c < sides; c++) {
                const double h = d->height[loop[c] * other->planes + k];
                low = h < low ? h : low, high = h > high ? h : high;
            }
            if (low > 2.0 * d->R + d->margin || high < -d->margin ||
                is_beside(other, k, d->at, loop, sides, d->margin))
                continue;
            if (append_index(l, j) || append_index(l, k)) return -1;
        }
    }
    l->first[section + 1] = l->n;
    return 0;
}

/* Sets flags of the faces over which a listed edge or vertex of the own core comes between -margin and
 * R + margin. */
FL_SIMD_VERSIONS static void find_faces_below(const direction *d, const fl_quick_list *l, int section)
{
    const int32_t planes = d->other->planes;
    const double low = -d->margin, high = d->R + d->margin;
    const fl_simd zero = {0}, one = 1.0 + zero;
    int32_t vertices, parts;
    const int32_t *v = fl_quick_section_of(l, section, &vertices),
                  *e = fl_quick_section_of(l, section + 1, &parts);
    for (int32_t f = 0; f < planes; f += FL_SIMD_WIDTH) {
        fl_simd_mask over = zero != 0.0;
        for (int32_t c = 0; c < vertices; c++) {
            const fl_simd h = FL_SIMD_LOAD(d->height + v[c] * planes + f);
            over |= (h >= low) & (h <= high);
        }
        for (int32_t c = 0; c < parts; c += 3) {
            const int32_t *end = d->own->edge[e[c]].end;
            const fl_simd a = FL_SIMD_LOAD(d->height + end[0] * planes + f),
                          b = FL_SIMD_LOAD(d->height + end[1] * planes + f);
            over |= ((a >= low) | (b >= low)) & ((a <= high) | (b <= high));
        }
        FL_SIMD_STORE(d->flags + f) = FL_SIMD_MASKED(over, one);
    }
}

/* True if one of them comes within reach of edge f of the other core. */
static int may_be_near(const direction *d, const fl_quick_list *l, int section, int32_t f)
{
    const fl_quick_edge *edge = &d->other->edge[f];
    const double near = d->R + d->margin;
    const int32_t *at;
    int32_t n;
    at = fl_quick_section_of(l, section, &n);
    for (int32_t c = 0; c < n; c++)
        if (point_from_edge(d->at[at[c]], edge) <= near) return 1;
    at = fl_quick_section_of(l, section + 1, &n);
    for (int32_t c = 0; c < n; c += 3) {
        const fl_quick_edge e = moved_edge(d, at[c]);
        if (edge_from_edge(&e, edge) <= near) return 1;
    }
    return 0;
}

static int append_direction(fl_quick_list *l, direction *d, int section)
{
    if (append_points(l, d, section) || append_faces(l, d, section + FL_QUICK_PAIR)) return -1;
    find_faces_below(d, l, section);
    for (int32_t f = 0; f < d->other->faces; f++)
        if (d->flags[f] > 0.0 && append_index(l, f)) return -1;
    l->first[section + FL_QUICK_EDGE] = l->n;
    for (int32_t f = 0; f < d->other->edges; f++)
        if (d->other_near[f] && may_be_near(d, l, section, f) && append_index(l, f)) return -1;
    l->first[section + FL_QUICK_KINDS] = l->n;
    return 0;
}

/* True if a foot of the common normal of two lines stays beyond the end of its edge.  Where points move by
 * the margin the feet move by less than 3 times that over sin^2. */
static int feet_outside(const fl_quick_edge *a, const fl_quick_edge *b, double C, double S2, double margin)
{
    const fl_vec3 w = v3_sub(a->a, b->a);
    const double wa = v3_dot(w, a->d), wb = v3_dot(w, b->d), t = C * wb - wa, u = wb - C * wa,
                 room = 3.0 * margin;
    return t < -room || t > S2 * a->length + room || u < -room || u > S2 * b->length + room;
}

/* Crossings: both feet may come inside both edges, within reach. */
static int append_crossings(fl_quick_list *l, const direction *d, const uint8_t *near_b)
{
    const double turn = d->margin / (d->own->bound + d->R) + LENGTH_TOL;
    for (int32_t e = 0; e < d->own->edges; e++) {
        if (!d->near[e]) continue;
        const fl_quick_edge a = moved_edge(d, e);
        for (int32_t f = 0; f < d->other->edges; f++) {
            const fl_quick_edge *b = &d->other->edge[f];
            const double C = v3_dot(a.d, b->d), S2 = 1.0 - C * C;
            if (!near_b[f] || !(a.weight * b->weight > 0.0) || sqrt(fmax(S2, 0.0)) + turn < FL_QUICK_ALONG)
                continue;
            if (feet_outside(&a, b, C, S2, d->margin) || edge_from_edge(&a, b) > d->R + d->margin) continue;
            if (append_index(l, e) || append_index(l, f)) return -1;
        }
    }
    return 0;
}

double fl_quick_list_margin(const fl_quick_list *l, double R)
{
    if (!(l->margin > 0.0)) return FIRST_MARGIN * R;
    const double best = sqrt(BUILD_COST * R * l->margin / (double)l->uses);
    return best < MIN_MARGIN * R ? MIN_MARGIN * R : best > MAX_MARGIN * R ? MAX_MARGIN * R : best;
}

int fl_quick_list_build(fl_quick_list *l, const fl_quick_shape *a, const fl_quick_shape *b, double ra,
                        double rb, double R, fl_mat3 M, fl_vec3 o, double margin)
{
    const double far = a->bound + R + margin, half = 0.5 * margin, turn = half / far;
    const double wide = margin + LENGTH_TOL * (a->bound + b->bound);
    const fl_mat3 N = {{{M.m[0][0], M.m[1][0], M.m[2][0]},
                        {M.m[0][1], M.m[1][1], M.m[2][1]},
                        {M.m[0][2], M.m[1][2], M.m[2][2]}}};
    const int32_t planes = a->planes > b->planes ? a->planes : b->planes;
    const int64_t room_a = (int64_t)a->vertices * (b->planes + 4),
                  room_b = (int64_t)b->vertices * (a->planes + 4);
    fl_err lost = {0};
    l->max_shift2 = 0.0; /* invalid until complete */
    l->n = 0, l->separated = 0;
    double *const block =
        fl_alloc(room_a + room_b + planes + (a->edges + b->edges) / 8 + 1, sizeof *block, &lost);
    if (!block) return -1;
    double *const flags = block + room_a + room_b;
    uint8_t *const near = (uint8_t *)(void *)(flags + planes);
    double *const ha = block + 4 * a->vertices, *const hb = block + room_a + 4 * b->vertices;
    direction d[2] = {{a, b, M, o, fl_quick_feature_radius(ra, rb), R, wide, (fl_vec3 *)(void *)block, ha,
                       ha - a->vertices, flags, near, near + a->edges},
                      {b, a, N, v3_neg(m3_mul(N, o)), fl_quick_feature_radius(rb, ra), R, wide,
                       (fl_vec3 *)(void *)(block + room_a), hb, hb - b->vertices, flags, near + a->edges,
                       near}};
    for (int k = 0; k < 2; k++) measure_heights(&d[k]);
    const int failed = append_direction(l, &d[0], 0) || append_direction(l, &d[1], FL_QUICK_KINDS) ||
                       append_crossings(l, &d[0], d[1].near);
    l->first[FL_QUICK_SECTIONS] = l->n;
    free(block);
    if (failed) return -1;
    l->M = M, l->o = o;
    l->max_shift2 = half * half, l->max_turn2 = turn * turn;
    l->margin = margin, l->uses = 1;
    return 0;
}

double fl_quick_list_bytes(const fl_quick_list *l)
{
    return (double)(sizeof *l + (size_t)l->cap * sizeof *l->index);
}

void fl_quick_list_free(fl_quick_list *l)
{
    free(l->index);
    *l = (fl_quick_list){0};
}
