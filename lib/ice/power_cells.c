/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/rng.h"
#include "geom/hilbert_order.h"
#include "ice/power_cells.h"
#include "shim/cgal_power.h"
#include "shim/cgal_voronoi.h"

/* Margin of the initial rectangle over the size of the polygon: no wall of the rectangle coincides with a
 * side of the polygon. */
#define CLEAR 0.05

double fl_outline_area(const fl_outline *a)
{
    return a->n ? fl_polygon_area(a->n, a->v) : (a->hi.x - a->lo.x) * (a->hi.y - a->lo.y);
}

/* Side k of the polygon. */
static fl_polygon_side wall_of(const fl_outline *a, int32_t k)
{
    const fl_vec2 p = a->v[k], q = a->v[k + 1 < a->n ? k + 1 : 0];
    const double dx = q.x - p.x, dy = q.y - p.y, s = 1.0 / hypot(dx, dy);
    return (fl_polygon_side){s * dy, -s * dx, s * (dy * p.x - dx * p.y), -5 - k};
}

int fl_outline_contains(const fl_outline *a, fl_vec2 p, double within)
{
    if (!(p.x >= a->lo.x + within && p.x <= a->hi.x - within && p.y >= a->lo.y + within &&
          p.y <= a->hi.y - within))
        return 0;
    for (int32_t k = 0; k < a->n; k++)
        if (fl_polygon_side_distance(wall_of(a, k), p) > -within) return 0;
    return 1;
}

void fl_random_sites_in_outline(int32_t n, uint64_t seed, const fl_outline *in, fl_vec2 *site)
{
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_SITE);
        do {
            site[i].x = fl_rng_in(&g, in->lo.x, in->hi.x);
            site[i].y = fl_rng_in(&g, in->lo.y, in->hi.y);
        } while (in->n && !fl_outline_contains(in, site[i], 0.0));
    }
}

void fl_random_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site)
{
    fl_random_sites_in_outline(n, seed, &(fl_outline){.lo = lo, .hi = hi}, site);
}

/* The sites along a Hilbert curve, so that neighbours are near in memory. name is the index of a site for
 * the caller; it defines all orders, so that no bit of a cell depends on the order of work. */
struct ordered_sites {
    int32_t *name;
    fl_vec2 *site;
    double *weight; /* NULL: all 0 */
    char *empty;
    int32_t *near_first, *near;
    int32_t *from, *count; /* offset of the cell in side and v, and its number of sides */
    fl_polygon_side *side;
    fl_vec2 *v;
};

static void free_sites(struct ordered_sites *r)
{
    free(r->name);
    free(r->site);
    free(r->weight);
    free(r->empty);
    free(r->near_first);
    free(r->near);
    free(r->from);
    free(r->count);
    free(r->side);
    free(r->v);
}

static int order_sites(struct ordered_sites *r, int32_t n, const fl_vec2 *site, const double *weight,
                       fl_err *err)
{
    if (!(r->name = fl_alloc(n, sizeof *r->name, err)) || !(r->site = fl_alloc(n, sizeof *r->site, err)) ||
        !(r->empty = fl_alloc(n, 1, err)) || (weight && !(r->weight = fl_alloc(n, sizeof(double), err))) ||
        !(r->near_first = fl_alloc((int64_t)n + 1, sizeof *r->near_first, err)) ||
        !(r->from = fl_alloc(n, sizeof *r->from, err)) || !(r->count = fl_alloc(n, sizeof *r->count, err)) ||
        fl_hilbert_order(n, site, r->name, err))
        return -1;
    for (int32_t k = 0; k < n; k++) {
        r->site[k] = site[r->name[k]];
        if (weight) r->weight[k] = weight[r->name[k]];
    }
    return weight ? fl_cgal_power_neighbours(n, r->site, r->weight, r->name, r->empty, r->near_first,
                                             &r->near, err)
                  : fl_cgal_neighbours(n, r->site, r->name, r->near_first, &r->near, err);
}

/* The half-plane nearer to site i, or of less power, than to site j.  It is always computed from the lower
 * to the higher name, so that both cells have the same line. */
static fl_polygon_side bisector_of(const struct ordered_sites *r, int32_t i, int32_t j)
{
    const int rising = r->name[i] < r->name[j];
    const int32_t l = rising ? i : j, h = rising ? j : i;
    const fl_vec2 a = r->site[l], b = r->site[h];
    const double dx = b.x - a.x, dy = b.y - a.y, s = (rising ? 1.0 : -1.0) / hypot(dx, dy);
    const double middle = dx * (0.5 * (a.x + b.x)) + dy * (0.5 * (a.y + b.y));
    return (fl_polygon_side){
        s * dx, s * dy, s * (r->weight ? middle + 0.5 * (r->weight[l] - r->weight[h]) : middle), r->name[j]};
}

/* Offset of cell k: a rectangle cut k times has at most 4 + k sides. */
static int64_t offset_of(const fl_outline *in, const struct ordered_sites *r, int32_t k)
{
    return r->near_first[k] + (4 + (int64_t)in->n) * k;
}

/* Cut all cells.  Each thread stores its cells contiguously from the offset of its first one, so that
 * unused memory stays untouched. */
static void cut_cells(struct ordered_sites *r, int32_t n, const fl_outline *in, fl_vec2 lo, fl_vec2 hi)
{
#pragma omp parallel
    {
        int32_t at = -1;
#pragma omp for schedule(static)
        for (int32_t k = 0; k < n; k++) {
            if (at < 0) at = (int32_t)offset_of(in, r, k);
            fl_vec2 *v = r->v + at;
            fl_polygon_side *side = r->side + at;
            int32_t m = r->empty[k] ? 0 : 4;
            fl_polygon_rectangle(lo, hi, v, side);
            for (int32_t e = r->near_first[k]; e < r->near_first[k + 1] && m > 0; e++)
                m = fl_polygon_cut(m, v, side, bisector_of(r, k, r->near[e]));
            for (int32_t e = 0; e < in->n && m > 0; e++) m = fl_polygon_cut(m, v, side, wall_of(in, e));
            r->from[k] = at;
            r->count[k] = m < 3 ? 0 : m;
            at += r->count[k];
        }
    }
}

/* Collect the cells in the order of their names. */
static int collect_cells(fl_power_cells *c, const struct ordered_sites *r, fl_err *err)
{
    const int32_t n = c->n;
    for (int32_t k = 0; k < n; k++) c->first[r->name[k] + 1] = r->count[k];
    for (int32_t i = 0; i < n; i++) {
        if (c->first[i + 1] == 0 && !r->weight)
            return fl_fail(err, FL_INPUT, "the cell of site %d vanishes: another site is too near", i);
        c->first[i + 1] += c->first[i];
    }
    c->side = fl_alloc(c->first[n], sizeof *c->side, err);
    c->v = fl_alloc(c->first[n], sizeof *c->v, err);
    if (!c->side || !c->v) return -1;
#pragma omp parallel for schedule(static)
    for (int32_t k = 0; k < n; k++) {
        const int32_t to = c->first[r->name[k]];
        memcpy(c->side + to, r->side + r->from[k], (size_t)r->count[k] * sizeof *c->side);
        memcpy(c->v + to, r->v + r->from[k], (size_t)r->count[k] * sizeof *c->v);
    }
    return 0;
}

int fl_power_cells_build_in(fl_power_cells *out, int32_t n, const fl_vec2 *site, const double *weight,
                            const fl_outline *in, fl_err *err)
{
    fl_power_cells c = {.n = n};
    struct ordered_sites r = {0};
    const double margin = in->n ? CLEAR * (in->hi.x - in->lo.x + in->hi.y - in->lo.y) : 0.0;
    const fl_vec2 lo = {in->lo.x - margin, in->lo.y - margin}, hi = {in->hi.x + margin, in->hi.y + margin};
    int32_t sides = 0, corners = 0;
    int rc = -1;
    c.first = fl_alloc((int64_t)n + 1, sizeof *c.first, err);
    if (!c.first || order_sites(&r, n, site, weight, err)) goto done;
    if (offset_of(in, &r, n) > INT32_MAX) {
        fl_fail(err, FL_INPUT, "%d cells in an outline of %d sides are too many, fewer are expected", n,
                in->n);
        goto done;
    }
    if (fl_grow(&r.side, &sides, offset_of(in, &r, n), sizeof *r.side, err) ||
        fl_grow(&r.v, &corners, offset_of(in, &r, n), sizeof *r.v, err))
        goto done;
    cut_cells(&r, n, in, lo, hi);
    if (collect_cells(&c, &r, err)) goto done;
    *out = c;
    c = (fl_power_cells){0};
    rc = 0;
done:
    free_sites(&r);
    fl_power_cells_free(&c);
    return rc;
}

int fl_power_cells_build(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                         fl_err *err)
{
    return fl_power_cells_build_in(out, n, site, NULL, &(fl_outline){.lo = lo, .hi = hi}, err);
}

void fl_power_cells_centroids(const fl_power_cells *c, fl_vec2 *site)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++)
        site[i] = fl_polygon_centroid(c->first[i + 1] - c->first[i], c->v + c->first[i]);
}

void fl_power_cells_areas(const fl_power_cells *c, double *area)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++)
        area[i] = fl_polygon_area(c->first[i + 1] - c->first[i], c->v + c->first[i]);
}

void fl_power_cells_free(fl_power_cells *c)
{
    free(c->first);
    free(c->side);
    free(c->v);
    *c = (fl_power_cells){0};
}
