/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "base/parallel.h"
#include "broad/bvh.h"
#include "geom/hilbert_order.h"
#include "ice/certificate.h"
#include "shim/cgal_voronoi.h"

static int32_t side_count(const fl_floes *a, int32_t i) { return a->first[i + 1] - a->first[i]; }
static const fl_vec2 *outer_of(const fl_floes *a, int32_t i) { return a->outer + a->first[i]; }

static int is_convex(int32_t n, const fl_vec2 *v)
{
    for (int32_t k = 0; k < n; k++) {
        const int32_t next = k + 1 < n ? k + 1 : 0;
        for (int32_t j = 0; j < n; j++)
            if (j != k && j != next && fl_cgal_orientation(v[k], v[next], v[j]) <= 0) return 0;
    }
    return n > 2;
}

static int side_separates(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b)
{
    for (int32_t k = 0; k < m; k++) {
        int32_t j = 0;
        while (j < n && fl_cgal_orientation(a[k], a[k + 1 < m ? k + 1 : 0], b[j]) < 0) j++;
        if (j == n) return 1;
    }
    return 0;
}

static int are_separate(const fl_floes *a, int32_t i, int32_t j)
{
    return side_separates(side_count(a, i), outer_of(a, i), side_count(a, j), outer_of(a, j)) ||
           side_separates(side_count(a, j), outer_of(a, j), side_count(a, i), outer_of(a, i));
}

static fl_aabb box_of(const fl_floes *a, int32_t i)
{
    fl_aabb b = aabb_empty();
    for (int32_t k = 0; k < side_count(a, i); k++)
        b = aabb_add(b, v3(outer_of(a, i)[k].x, outer_of(a, i)[k].y, 0.0));
    return b;
}

/* The nearest pair so far; of equally near pairs the first. */
struct nearest {
    double gap;
    int32_t i, j;
};

static void keep_nearest(struct nearest *n, double gap, int32_t i, int32_t j)
{
    if (gap > n->gap || (gap == n->gap && (i > n->i || (i == n->i && j >= n->j)))) return;
    *n = (struct nearest){gap, i, j};
}

/* Floes in the order of a Hilbert curve, so that neighbours are near in memory and still in the cache. */
struct ordered_floes {
    const fl_floes *a;
    int32_t *floe; /* [n] at position k */
    fl_aabb *box;  /* [n] of that floe [m] */
    fl_bvh tree;
};

/* Evaluate the pairs of the floe at position k with near floes at higher positions. */
static int evaluate_near_pairs(const struct ordered_floes *r, double reach, int32_t k, int32_t **near,
                               int32_t *cap, int64_t *overlaps, struct nearest *n, fl_err *err)
{
    const fl_floes *a = r->a;
    const fl_aabb q = aabb_grow(r->box[k], reach);
    int32_t got;
    while ((got = fl_bvh_query(&r->tree, r->box, q, *near, *cap)) > *cap)
        if (fl_grow(near, cap, got, sizeof **near, err)) return -1;
    for (int32_t e = 0; e < got; e++) {
        const int32_t l = (*near)[e];
        if (l <= k) continue;
        const int32_t i = r->floe[k] < r->floe[l] ? r->floe[k] : r->floe[l], j = r->floe[k] + r->floe[l] - i;
        if (aabb_overlap(r->box[k], r->box[l]) && !are_separate(a, i, j)) {
            ++*overlaps;
            keep_nearest(n, 0.0, i, j);
        } else {
            keep_nearest(
                n, fl_polygon_distance(side_count(a, i), outer_of(a, i), side_count(a, j), outer_of(a, j)), i,
                j);
        }
    }
    return 0;
}

/* Evaluate all pairs within `reach`: count overlaps, find the nearest pair.  Boxes that touch are within
 * any reach >= 0, so each pass counts all overlaps. */
static int evaluate_pairs(const struct ordered_floes *r, double reach, fl_certificate *out, fl_err *err)
{
    struct nearest best = {INFINITY, INT32_MAX, INT32_MAX};
    int64_t overlaps = 0;
    int failed = 0;
#pragma omp parallel reduction(+ : overlaps) reduction(| : failed)
    {
        struct nearest mine = {INFINITY, INT32_MAX, INT32_MAX};
        int32_t *near = NULL, cap = 0;
        fl_err why = {0};
#pragma omp for schedule(static)
        for (int32_t k = 0; k < r->a->n; k++)
            if (!failed && evaluate_near_pairs(r, reach, k, &near, &cap, &overlaps, &mine, &why)) failed = 1;
        free(near);
#pragma omp critical
        {
            keep_nearest(&best, mine.gap, mine.i, mine.j);
            if (failed && err->code == 0) *err = why;
        }
    }
    out->overlaps = overlaps;
    out->min_gap = best.gap;
    out->min_gap_pair[0] = best.gap < INFINITY ? best.i : -1;
    out->min_gap_pair[1] = best.gap < INFINITY ? best.j : -1;
    return failed ? -1 : 0;
}

static int order_floes(struct ordered_floes *r, fl_err *err)
{
    const int32_t n = r->a->n;
    fl_vec2 *corner = fl_alloc(n, sizeof *corner, err);
    int rc = -1;
    r->floe = fl_alloc(n, sizeof *r->floe, err);
    r->box = fl_alloc(n, sizeof *r->box, err);
    if (!corner || !r->floe || !r->box) goto done;
    for (int32_t i = 0; i < n; i++) corner[i] = outer_of(r->a, i)[0];
    if (fl_hilbert_order(n, corner, r->floe, err)) goto done;
    for (int32_t k = 0; k < n; k++) r->box[k] = box_of(r->a, r->floe[k]);
    rc = fl_bvh_build(&r->tree, r->box, n, err);
done:
    free(corner);
    return rc;
}

static int measure_pairs(const fl_floes *a, fl_certificate *out, fl_err *err)
{
    struct ordered_floes r = {.a = a};
    fl_aabb all = aabb_empty();
    /* neighbours are two insets apart: one pass finds the nearest pair, unless floes are sparse */
    double reach = 2.0 * a->inset * (1.0 + 1e-9), far;
    int rc = -1;
    if (order_floes(&r, err)) goto done;
    for (int32_t k = 0; k < a->n; k++) all = aabb_join(all, r.box[k]);
    far = hypot(all.hi.x - all.lo.x, all.hi.y - all.lo.y);
    if (!(reach > 1e-6 * far)) reach = 1e-6 * far;
    for (;; reach *= 2.0) {
        if (evaluate_pairs(&r, reach, out, err)) goto done;
        if (out->min_gap <= reach || reach > far) break;
    }
    rc = 0;
done:
    fl_bvh_free(&r.tree);
    free(r.box);
    free(r.floe);
    return rc;
}

static double corner_angle(const fl_vec2 *v, int32_t k, int32_t n)
{
    const fl_vec2 p = v[k ? k - 1 : n - 1], q = v[k + 1 < n ? k + 1 : 0];
    const double ax = p.x - v[k].x, ay = p.y - v[k].y, bx = q.x - v[k].x, by = q.y - v[k].y;
    return atan2(fabs(ax * by - ay * bx), ax * bx + ay * by);
}

static int measure_areas(const fl_floes *a, fl_certificate *out, fl_err *err)
{
    double *area = fl_alloc(a->n, sizeof *area, err), *square = fl_alloc(a->n, sizeof *square, err);
    if (area && square) {
        for (int32_t i = 0; i < a->n; i++) area[i] = fl_polygon_area(side_count(a, i), outer_of(a, i));
        out->total_area = fl_parallel_sum(area, a->n);
        out->mean_area = out->total_area / a->n;
        out->min_area_floe = out->max_area_floe = 0;
        for (int32_t i = 0; i < a->n; i++) {
            square[i] = (area[i] - out->mean_area) * (area[i] - out->mean_area);
            if (area[i] < area[out->min_area_floe]) out->min_area_floe = i;
            if (area[i] > area[out->max_area_floe]) out->max_area_floe = i;
        }
        out->min_area = area[out->min_area_floe];
        out->max_area = area[out->max_area_floe];
        out->cv = sqrt(fl_parallel_sum(square, a->n) / a->n) / out->mean_area;
    }
    free(square);
    free(area);
    return area && square ? 0 : -1;
}

static int32_t count_nonconvex(const fl_floes *a)
{
    int32_t nonconvex = 0;
#pragma omp parallel for schedule(static) reduction(+ : nonconvex)
    for (int32_t i = 0; i < a->n; i++)
        nonconvex += !is_convex(side_count(a, i), a->core + a->first[i]) ||
                     !is_convex(side_count(a, i), outer_of(a, i));
    return nonconvex;
}

int fl_certificate_make(fl_certificate *out, const fl_floes *a, fl_err *err)
{
    fl_certificate c = {.min_side = INFINITY, .min_angle = INFINITY};
    for (int32_t i = 0; i < a->n; i++) {
        const fl_vec2 *v = a->core + a->first[i];
        const int32_t n = side_count(a, i);
        for (int32_t k = 0; k < n; k++) {
            const fl_vec2 p = v[k], q = v[k + 1 < n ? k + 1 : 0];
            const double edge = hypot(q.x - p.x, q.y - p.y), angle = corner_angle(v, k, n);
            if (edge < c.min_side) {
                c.min_side = edge;
                c.min_side_floe = i;
            }
            if (angle < c.min_angle) {
                c.min_angle = angle;
                c.min_angle_floe = i;
            }
        }
    }
    c.nonconvex = count_nonconvex(a);
    c.mean_sides = (double)a->first[a->n] / a->n;
    if (measure_areas(a, &c, err) || measure_pairs(a, &c, err)) return -1;
    *out = c;
    return 0;
}
