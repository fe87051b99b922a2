/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "patch/quick_list.h"
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
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
    double *height; /* [own->vertices * other->faces] */
    uint8_t *near;  /* [own->edges] near the other core, and [other->edges] near the own one: */
    const uint8_t *other_near;
} direction;

static int append_index(fl_quick_list *l, int32_t k)
{
    if (fl_reserve(&l->index, &l->cap, (int64_t)l->n + 1, sizeof *l->index)) return -1;
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

static void measure_heights(const direction *d)
{
    const int32_t faces = d->other->faces;
    for (int32_t v = 0; v < d->own->vertices; v++) {
        d->at[v] = v3_add(m3_mul(d->M, d->own->vertex[v]), d->o);
        for (int32_t f = 0; f < faces; f++)
            d->height[v * faces + f] = v3_dot(d->other->face[f].n, d->at[v]) - d->other->face[f].height;
    }
}

/* Lower bound of the distance of the part from t to u of an edge from the other core, t = u = 0: a vertex. */
static double least_distance(const direction *d, const int32_t *end, double t, double u)
{
    const int32_t faces = d->other->faces;
    const double *a = d->height + end[0] * faces, *b = d->height + end[1] * faces;
    double most = -INFINITY;
    for (int32_t f = 0; f < faces; f++) {
        const double rise = b[f] - a[f];
        most = fmax(most, a[f] + rise * (rise > 0.0 ? t : u));
    }
    return most;
}

static void find_near_edges(const direction *d)
{
    for (int32_t e = 0; e < d->own->edges; e++)
        d->near[e] = least_distance(d, d->own->edge[e].end, 0.0, 1.0) <= d->R + d->margin;
}

static int append_points(fl_quick_list *l, direction *d, int section)
{
    const double near = d->R + d->margin;
    l->first[section] = l->n;
    for (int32_t v = 0; v < d->own->vertices; v++)
        if (d->own->weight[v] > 0.0 && least_distance(d, (int32_t[]){v, v}, 0.0, 0.0) <= near &&
            append_index(l, v))
            return -1;
    l->first[section + 1] = l->n;
    for (int32_t e = 0; e < d->own->edges; e++) {
        const fl_quick_edge *edge = &d->own->edge[e];
        if (!d->near[e] || !(edge->weight > 0.0)) continue;
        const int32_t n = fl_quick_segments(edge, d->rho);
        for (int32_t k = 0; k < n; k++)
            if (least_distance(d, edge->end, (k + FL_LINE4_NODE[0]) / n,
                               (k + FL_LINE4_NODE[FL_LINE4_NODES - 1]) / n) <= near &&
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

static int append_faces(fl_quick_list *l, const direction *d, int section)
{
    const fl_quick_shape *own = d->own, *other = d->other;
    const double tilt = FACING - d->margin / (own->bound + d->R);
    for (int32_t j = 0; j < own->faces; j++) {
        const fl_vec3 n = m3_mul(d->M, own->face[j].n);
        const int32_t *loop = own->loop + own->face[j].first, sides = own->face[j].sides;
        for (int32_t k = 0; k < other->faces; k++) {
            double low = INFINITY, high = -INFINITY;
            if (-v3_dot(n, other->face[k].n) < tilt) continue;
            for (int32_t c = 0; c < sides; c++) {
                const double h = d->height[loop[c] * other->faces + k];
                low = fmin(low, h), high = fmax(high, h);
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

/* True if a listed edge or vertex of the own core comes between -margin and R + margin over face f. */
static int may_be_over(const direction *d, const fl_quick_list *l, int section, int32_t f)
{
    const int32_t faces = d->other->faces, *at;
    const double low = -d->margin, high = d->R + d->margin;
    int32_t n;
    at = fl_quick_section_of(l, section, &n);
    for (int32_t c = 0; c < n; c++) {
        const double h = d->height[at[c] * faces + f];
        if (h >= low && h <= high) return 1;
    }
    at = fl_quick_section_of(l, section + 1, &n);
    for (int32_t c = 0; c < n; c += 3) {
        const int32_t *end = d->own->edge[at[c]].end;
        const double a = d->height[end[0] * faces + f], b = d->height[end[1] * faces + f];
        if (fmax(a, b) >= low && fmin(a, b) <= high) return 1;
    }
    return 0;
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
    for (int32_t f = 0; f < d->other->faces; f++)
        if (may_be_over(d, l, section, f) && append_index(l, f)) return -1;
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
    const int64_t room_a = (int64_t)a->vertices * (b->faces + 3),
                  room_b = (int64_t)b->vertices * (a->faces + 3);
    fl_err lost = {0};
    l->max_shift2 = 0.0; /* invalid until complete */
    l->n = 0, l->separated = 0;
    double *const block = fl_alloc(room_a + room_b + (a->edges + b->edges) / 8 + 1, sizeof *block, &lost);
    if (!block) return -1;
    uint8_t *const near = (uint8_t *)(void *)(block + room_a + room_b);
    direction d[2] = {{a, b, M, o, fl_quick_feature_radius(ra, rb), R, wide, (fl_vec3 *)(void *)block,
                       block + 3 * a->vertices, near, near + a->edges},
                      {b, a, N, v3_neg(m3_mul(N, o)), fl_quick_feature_radius(rb, ra), R, wide,
                       (fl_vec3 *)(void *)(block + room_a), block + room_a + 3 * b->vertices, near + a->edges,
                       near}};
    for (int k = 0; k < 2; k++) measure_heights(&d[k]), find_near_edges(&d[k]);
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
