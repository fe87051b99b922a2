/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/simd.h"
#include "patch/quick_points.h"
#include "base/array.h"
#include "base/pi.h"
#include "geom/quadrature_rules.h"
#include "patch/patch_law.h"

#define ON_PLANE_TOL 1e-12 /* of the sizes: how far below all planes a point still lies on one */

#define DOT(v, a) ((v).x * (a)[0] + (v).y * (a)[1] + (v).z * (a)[2])

_Static_assert((int)FL_LINE4_NODES == (int)FL_SIMD_WIDTH, "a segment is a register of points");

/* Features of the other core from which distances are taken. */
typedef struct {
    const fl_quick_shape *s;
    const int32_t *face, *edge;
    int32_t faces, edges;
    double tol;
    fl_simd *height; /* [faces] of four points over the planes */
} nearest_features;

/* The nearest points of four points x. */
typedef struct {
    fl_simd d, n[3];      /* distance and direction from there */
    fl_simd_mask on_face; /* it lies in a face */
    /* of an edge: direction, place of the foot from one end, length */
    fl_simd b[3], t, length;
} nearest_point;

#define CHOOSE(to, m, v) (to) = FL_SIMD_SELECT(m, v, to)

/* Nearest points that are nearer than reach, d = infinity else.  One lies in a face only if that is
 * the face over which x is highest. */
FL_SIMD_INLINE void find_nearest(nearest_point *q, const nearest_features *of, const fl_simd x[3],
                                 double reach, int edges_too)
{
    const fl_simd zero = {0};
    fl_simd top = zero - INFINITY, which = zero - 1.0;
    fl_simd_mask in = zero != 0.0;
    for (int32_t k = 0; k < of->faces; k++) {
        const fl_quick_face *f = &of->s->face[of->face[k]];
        const fl_simd h = DOT(f->n, x) - f->height;
        const fl_simd_mask higher = h > top;
        of->height[k] = h;
        CHOOSE(top, higher, h), CHOOSE(which, higher, (double)k + zero);
    }
    FL_SIMD_UNROLL
    for (int c = 0; c < 3; c++) q->n[c] = zero, q->b[c] = zero;
    q->t = q->length = zero;
    q->d = zero + INFINITY;
    const fl_simd_mask within = top < reach; /* no point is nearer than it is high */
    q->on_face = in;
    if (!fl_simd_any(&within)) return;
    for (int32_t k = 0; k < of->faces; k++) {
        const fl_simd_mask mine = (which == (double)k) & (top > -of->tol) & within;
        if (!fl_simd_any(&mine)) continue;
        const fl_quick_face *f = &of->s->face[of->face[k]];
        const fl_quick_side *side = of->s->side + f->first;
        fl_simd_mask inside = mine;
        for (int32_t c = 0; c < f->sides; c++) inside &= DOT(side[c].q, x) <= side[c].c;
        CHOOSE(q->d, inside, top);
        CHOOSE(q->n[0], inside, f->n.x + zero), CHOOSE(q->n[1], inside, f->n.y + zero);
        CHOOSE(q->n[2], inside, f->n.z + zero);
        in |= inside;
    }
    q->on_face = in;
    const fl_simd_mask out = ~in & within;
    if (!fl_simd_any(&out)) return;
    fl_simd best = zero + INFINITY, offset[3] = {zero, zero, zero};
    for (int32_t k = 0; k < of->edges; k++) {
        const fl_quick_edge *e = &of->s->edge[of->edge[k]];
        fl_simd r[3] = {x[0] - e->a.x, x[1] - e->a.y, x[2] - e->a.z};
        const fl_simd along = DOT(e->d, r), up = FL_SIMD_MAX(along, zero),
                      t = FL_SIMD_MIN(up, e->length + zero);
        r[0] -= t * e->d.x, r[1] -= t * e->d.y, r[2] -= t * e->d.z;
        const fl_simd d2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
        const fl_simd_mask nearer = (d2 < best) & out;
        CHOOSE(best, nearer, d2);
        CHOOSE(offset[0], nearer, r[0]), CHOOSE(offset[1], nearer, r[1]), CHOOSE(offset[2], nearer, r[2]);
        if (!edges_too) continue;
        CHOOSE(q->b[0], nearer, e->d.x + zero), CHOOSE(q->b[1], nearer, e->d.y + zero);
        CHOOSE(q->b[2], nearer, e->d.z + zero), CHOOSE(q->t, nearer, t),
            CHOOSE(q->length, nearer, e->length + zero);
    }
    fl_simd d;
    for (int k = 0; k < FL_SIMD_WIDTH; k++) d[k] = sqrt(best[k]);
    const fl_simd each = 1.0 / d;
    const fl_simd_mask apart = out & (best > 0.0);
    CHOOSE(q->d, apart, d);
    FL_SIMD_UNROLL
    for (int c = 0; c < 3; c++) CHOOSE(q->n[c], apart, each * offset[c]);
}

static void keep_most(double *overlap, const fl_simd *s)
{
    for (int k = 0; k < FL_SIMD_WIDTH; k++)
        if ((*s)[k] > *overlap) *overlap = (*s)[k];
}

FL_SIMD_VERSIONS static void add_vertices(const fl_quick_direction *d, const nearest_features *of,
                                          const int32_t *at, int32_t n, fl_quick_total *to, double *overlap)
{
    const double factor = FL_PATCH_ROUND_FACTOR * (0.4 * PI) * d->rho;
    const fl_simd zero = {0}, one = 1.0 + zero;
    for (int32_t c = 0; c < n; c += FL_SIMD_WIDTH) {
        fl_simd x[3] = {zero, zero, zero}, weight = zero;
        for (int k = 0; k < FL_SIMD_WIDTH && c + k < n; k++) {
            const fl_vec3 v = v3_add(m3_mul(d->M, d->own->vertex[at[c + k]]), d->o);
            x[0][k] = v.x, x[1][k] = v.y, x[2][k] = v.z, weight[k] = d->own->weight[at[c + k]];
        }
        nearest_point q;
        find_nearest(&q, of, x, d->reach, 0);
        const fl_simd_mask on = (q.d < d->reach) & (weight > 0.0);
        if (!fl_simd_any(&on)) continue;
        const fl_simd s = FL_SIMD_MASKED(on, d->reach - q.d), s2 = s * s, k4 = factor * weight * s2 * s2,
                      down = 0.5 * s - d->r;
        fl_simd p[3];
        FL_SIMD_UNROLL
        for (int k = 0; k < 3; k++) p[k] = x[k] + down * q.n[k];
        fl_quick_lanes row;
        FL_QUICK_SET_POINT(&row, k4 * s, 5.0 * k4, 20.0 * k4 / FL_SIMD_SELECT(on, s, one), q.n, p);
        fl_quick_add_lanes(to, &row);
        keep_most(overlap, &s);
    }
}

/* A segment of an edge of the own core: u = weight s^(9/2) o of each point, o of quick_law.h. */
FL_SIMD_VERSIONS static void add_segment(const fl_quick_direction *d, const nearest_features *of,
                                         const fl_quick_edge *e, fl_vec3 from, fl_vec3 along, int32_t part,
                                         int32_t parts, double factor, fl_quick_total *to, double *overlap)
{
    const fl_simd zero = {0}, one = 1.0 + zero;
    const fl_simd node = FL_SIMD_LOAD(FL_LINE4_NODE), share = FL_SIMD_LOAD(FL_LINE4_WEIGHT);
    const double l = e->length / (double)parts;
    const fl_simd place = l * ((double)part + node);
    const fl_simd x[3] = {from.x + place * along.x, from.y + place * along.y, from.z + place * along.z};
    nearest_point q;
    find_nearest(&q, of, x, d->reach, 1);
    const fl_simd_mask on = q.d < d->reach;
    if (!fl_simd_any(&on)) return;
    const fl_simd s = FL_SIMD_MASKED(on, d->reach - q.d), s2 = s * s;
    fl_simd root;
    for (int k = 0; k < FL_SIMD_WIDTH; k++) root[k] = sqrt(s[k]);
    const fl_simd k3 = (factor * l) * share * s2 * s * root, all = k3 * s, down = 0.5 * s - d->r;
    fl_simd p[3];
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) p[k] = x[k] + down * q.n[k];
    fl_quick_lanes row;
    const fl_simd_mask beside = on & ~q.on_face;
    const fl_simd per_s = 1.0 / FL_SIMD_SELECT(on, s, one);
    if (!fl_simd_any(&beside)) {
        FL_QUICK_SET_POINT(&row, all, 4.5 * k3, 15.75 * k3 * per_s, q.n, p);
        fl_quick_add_lanes(to, &row);
        keep_most(overlap, &s);
        return;
    }
    /* none = 1 - H: product over faces of 1 - h(y), y = height/d; turned: of its gradient */
    const fl_simd per = 1.0 / FL_SIMD_SELECT(beside, q.d, one);
    fl_simd none = one, turned[3] = {zero, zero, zero}, stretch = zero;
    for (int32_t k = 0; k < of->faces; k++) {
        const fl_simd y = of->height[k] * per,
                      z0 = (y - FL_QUICK_FACE_ONLY) * (1.0 / (1.0 - FL_QUICK_FACE_ONLY));
        const fl_simd_mask some = z0 > 0.0;
        if (!fl_simd_any(&some)) continue;
        const fl_simd z = FL_SIMD_MIN(FL_SIMD_MAX(z0, zero), one), rest = 1.0 - z,
                      less = rest * rest * rest * (1.0 + z * (3.0 + 6.0 * z));
        const fl_simd_mask known = (less > 0.0) & some;
        const fl_simd slope = FL_SIMD_MASKED(known, FL_QUICK_SLOPE(z) * (1.0 / (1.0 - FL_QUICK_FACE_ONLY)) /
                                                        FL_SIMD_SELECT(known, less, one));
        const fl_vec3 n = of->s->face[of->face[k]].n;
        none *= less;
        turned[0] += slope * n.x, turned[1] += slope * n.y, turned[2] += slope * n.z;
        stretch += slope * y;
    }
    none = FL_SIMD_MASKED(beside, none);
    /* share of the nearest edge that is parallel, (1 - g) t */
    const fl_simd C = along.x * q.b[0] + along.y * q.b[1] + along.z * q.b[2],
                  past = (1.0 - FL_QUICK_ALONG * FL_QUICK_ALONG - C * C) * (1.0 / FL_QUICK_PARALLEL);
    const fl_simd z = FL_SIMD_MIN(FL_SIMD_MAX(past, zero), one), parallel = 1.0 - FL_QUICK_STEP(z),
                  bends = FL_QUICK_SLOPE(z) * (2.0 / FL_QUICK_PARALLEL) * C; /* d parallel/dC */
    const fl_simd end = q.length - q.t, half = 0.5 * q.length;
    const fl_simd_mask first = q.t < end;
    const fl_simd width = FL_SIMD_SELECT(beside, FL_SIMD_MIN(FL_QUICK_TAPER * d->R + zero, half), one),
                  v = FL_SIMD_MIN(FL_SIMD_SELECT(first, q.t, end) / width, one), t = FL_QUICK_STEP(v),
                  dt = FL_QUICK_SLOPE(v) / FL_SIMD_SELECT(first, width, -width);
    const fl_simd o = 1.0 - none * (1.0 - parallel * t);
    FL_QUICK_SET_POINT(&row, all * o, 4.5 * k3 * o, 15.75 * k3 * per_s * o, q.n, p);
    /* do = (1 - parallel t) none sum slope (n_k - y n).u/d + none (t bends dC + parallel dt b.u) */
    const fl_simd by_turn = all * none * (1.0 - parallel * t) * per, by_foot = all * none * parallel * dt,
                  by_C = all * none * t * bends;
    fl_simd f[3];
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) f[k] = by_turn * (turned[k] - stretch * q.n[k]) + by_foot * q.b[k];
    const fl_simd turn[3] = {along.y * q.b[2] - along.z * q.b[1], along.z * q.b[0] - along.x * q.b[2],
                             along.x * q.b[1] - along.y * q.b[0]};
    FL_SIMD_UNROLL
    for (int k = 0; k < 3; k++) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        row.a[FL_QUICK_F + k] -= FL_SIMD_MASKED(beside, f[k]);
        row.a[FL_QUICK_M + k] -= FL_SIMD_MASKED(beside, x[a] * f[b] - x[b] * f[a] + by_C * turn[k]);
    }
    fl_quick_add_lanes(to, &row);
    keep_most(overlap, &s);
}

/* Adds v times the sum of an edge, and the gradient of v. */
static void add_edge(const fl_quick_total *sum, double v, const fl_quick_edge *e,
                     const fl_quick_support *support, int32_t n, fl_quick_total *to)
{
    fl_quick_add_total(to, v, sum);
    for (int32_t k = 0; k < n; k++) {
        double others = sum->a[FL_QUICK_U];
        if (support[k].face != e->face[0] && support[k].face != e->face[1]) continue;
        for (int32_t i = 0; i < n; i++)
            if (i != k && (support[i].face == e->face[0] || support[i].face == e->face[1]))
                others *= 1.0 - support[i].share;
        fl_quick_add_wrench(to, others, support[k].rise);
        to->a[FL_QUICK_REACH] -= others * support[k].reach;
    }
}

FL_SIMD_INLINE void add_edges(const fl_quick_direction *d, const nearest_features *of,
                              const fl_quick_support *support, int32_t n, fl_quick_total *to, double *overlap)
{
    int32_t parts;
    const int32_t *at = fl_quick_section_of(d->l, d->section + FL_QUICK_SEGMENTS, &parts);
    const double factor = FL_PATCH_ROUND_FACTOR * (256.0 / 315.0) * sqrt(2.0 * d->rho);
    for (int32_t k = 0; k < parts;) {
        const int32_t edge = at[k];
        const fl_quick_edge *e = &d->own->edge[edge];
        double v = 1.0;
        for (int32_t i = 0; i < n; i++)
            if (support[i].face == e->face[0] || support[i].face == e->face[1]) v *= 1.0 - support[i].share;
        if (!(v > 0.0)) {
            while (k < parts && at[k] == edge) k += 3;
            continue;
        }
        const fl_vec3 from = v3_add(m3_mul(d->M, e->a), d->o), along = m3_mul(d->M, e->d);
        fl_quick_total sum = {{0}};
        for (; k < parts && at[k] == edge; k += 3)
            add_segment(d, of, e, from, along, at[k + 1], at[k + 2], factor * e->weight, &sum, overlap);
        if (sum.a[FL_QUICK_U] > 0.0) add_edge(&sum, v, e, support, n, to);
    }
}

FL_SIMD_VERSIONS int fl_quick_add_points(fl_quick_scratch *w, const fl_quick_direction *d,
                                         const fl_quick_support *support, int32_t n, fl_quick_total *to,
                                         double *overlap)
{
    nearest_features of = {.s = d->other, .tol = ON_PLANE_TOL * (d->own->bound + d->other->bound)};
    of.face = fl_quick_section_of(d->l, d->section + FL_QUICK_FACE, &of.faces);
    of.edge = fl_quick_section_of(d->l, d->section + FL_QUICK_EDGE, &of.edges);
    if (fl_reserve(&w->height, &w->height_cap, of.faces, sizeof *of.height)) return -1;
    of.height = w->height;
    int32_t vertices;
    const int32_t *at = fl_quick_section_of(d->l, d->section + FL_QUICK_VERTEX, &vertices);
    add_vertices(d, &of, at, vertices, to, overlap);
    add_edges(d, &of, support, n, to, overlap);
    return 0;
}
