/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/mem.h"
#include "base/rng.h"
#include "ice/cells.h"
#include "shim/cgal_power.h"
#include "shim/cgal_voronoi.h"

/* The rectangle that the sides of a polygon cut is larger than its box by this part, so that every cut is a
 * plain one: no wall of the rectangle runs along a side of the polygon. */
#define CLEAR 0.05

double fl_outline_area(const fl_outline *a)
{
    return a->n ? fl_polygon_area(a->n, a->v) : (a->hi.x - a->lo.x) * (a->hi.y - a->lo.y);
}

/* Side k of the polygon. */
static fl_side wall(const fl_outline *a, int32_t k)
{
    const fl_vec2 p = a->v[k], q = a->v[k + 1 < a->n ? k + 1 : 0];
    const double dx = q.x - p.x, dy = q.y - p.y, s = 1.0 / hypot(dx, dy);
    return (fl_side){s * dy, -s * dx, s * (dy * p.x - dx * p.y), -5 - k};
}

int fl_outline_holds(const fl_outline *a, fl_vec2 p, double within)
{
    if (!(p.x >= a->lo.x + within && p.x <= a->hi.x - within && p.y >= a->lo.y + within &&
          p.y <= a->hi.y - within))
        return 0;
    for (int32_t k = 0; k < a->n; k++)
        if (fl_side_beyond(wall(a, k), p) > -within) return 0;
    return 1;
}

void fl_cells_sites_in(int32_t n, uint64_t seed, const fl_outline *in, fl_vec2 *site)
{
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_SITE);
        do {
            site[i].x = fl_rng_in(&g, in->lo.x, in->hi.x);
            site[i].y = fl_rng_in(&g, in->lo.y, in->hi.y);
        } while (in->n && !fl_outline_holds(in, site[i], 0.0));
    }
}

void fl_cells_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site)
{
    fl_cells_sites_in(n, seed, &(fl_outline){.lo = lo, .hi = hi}, site);
}

/* What is nearer, or of less power, to site i than to site j.  Always computed from the lower to the higher
 * index, so that both cells see one line. */
static fl_side bisector(const fl_vec2 *site, const double *weight, int32_t i, int32_t j)
{
    const int32_t l = i < j ? i : j, h = i < j ? j : i;
    const fl_vec2 a = site[l], b = site[h];
    const double dx = b.x - a.x, dy = b.y - a.y, s = (i < j ? 1.0 : -1.0) / hypot(dx, dy);
    const double middle = dx * (0.5 * (a.x + b.x)) + dy * (0.5 * (a.y + b.y));
    return (fl_side){s * dx, s * dy, s * (weight ? middle + 0.5 * (weight[l] - weight[h]) : middle), j};
}

/* A rectangle cut k times has at most 4 + k sides; that is the room each cell gets first. */
static int32_t room(const fl_outline *in, const int32_t *near_first, int32_t i)
{
    return near_first[i] + (4 + in->n) * i;
}

static int neighbours(int32_t n, const fl_vec2 *site, const double *weight, char *empty, int32_t *first,
                      int32_t **near, fl_err *err)
{
    return weight ? fl_cgal_power_neighbours(n, site, weight, empty, first, near, err)
                  : fl_cgal_neighbours(n, site, first, near, err);
}

int fl_cells_build_in(fl_cells *out, int32_t n, const fl_vec2 *site, const double *weight,
                      const fl_outline *in, fl_err *err)
{
    fl_cells c = {.n = n};
    const double margin = in->n ? CLEAR * (in->hi.x - in->lo.x + in->hi.y - in->lo.y) : 0.0;
    const fl_vec2 lo = {in->lo.x - margin, in->lo.y - margin}, hi = {in->hi.x + margin, in->hi.y + margin};
    int32_t *near_first = fl_alloc((int64_t)n + 1, sizeof *near_first, err), *near = NULL;
    char *empty = fl_alloc(n, 1, err);
    int rc = -1;
    c.first = fl_alloc((int64_t)n + 1, sizeof *c.first, err);
    if (!near_first || !c.first || !empty || neighbours(n, site, weight, empty, near_first, &near, err))
        goto done;
    if (near_first[n] + (4 + (int64_t)in->n) * n > INT32_MAX) {
        fl_fail(err, FL_INPUT, "%d cells in an outline of %d sides are too many, fewer were wanted", n,
                in->n);
        goto done;
    }
    c.side = fl_alloc(room(in, near_first, n), sizeof *c.side, err);
    c.v = fl_alloc(room(in, near_first, n), sizeof *c.v, err);
    if (!c.side || !c.v) goto done;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < n; i++) {
        fl_vec2 *v = c.v + room(in, near_first, i);
        fl_side *side = c.side + room(in, near_first, i);
        int32_t m = empty[i] ? 0 : 4;
        fl_polygon_rectangle(lo, hi, v, side);
        for (int32_t k = near_first[i]; k < near_first[i + 1] && m > 0; k++)
            m = fl_polygon_cut(m, v, side, bisector(site, weight, i, near[k]));
        for (int32_t k = 0; k < in->n && m > 0; k++) m = fl_polygon_cut(m, v, side, wall(in, k));
        c.first[i + 1] = m;
    }
    for (int32_t i = 0; i < n; i++) { /* close the gaps; the target never passes the source */
        const int32_t m = c.first[i + 1] < 3 ? 0 : c.first[i + 1], from = room(in, near_first, i);
        if (m == 0 && !weight) {
            fl_fail(err, FL_INPUT, "the cell of site %d vanishes: another site is too near", i);
            goto done;
        }
        memmove(c.v + c.first[i], c.v + from, (size_t)m * sizeof *c.v);
        memmove(c.side + c.first[i], c.side + from, (size_t)m * sizeof *c.side);
        c.first[i + 1] = c.first[i] + m;
    }
    *out = c;
    c = (fl_cells){0};
    rc = 0;
done:
    free(empty);
    free(near_first);
    free(near);
    fl_cells_free(&c);
    return rc;
}

int fl_cells_build(fl_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi, fl_err *err)
{
    return fl_cells_build_in(out, n, site, NULL, &(fl_outline){.lo = lo, .hi = hi}, err);
}

void fl_cells_centroids(const fl_cells *c, fl_vec2 *site)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++)
        site[i] = fl_polygon_centroid(c->first[i + 1] - c->first[i], c->v + c->first[i]);
}

void fl_cells_areas(const fl_cells *c, double *area)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++)
        area[i] = fl_polygon_area(c->first[i + 1] - c->first[i], c->v + c->first[i]);
}

void fl_cells_free(fl_cells *c)
{
    free(c->first);
    free(c->side);
    free(c->v);
    *c = (fl_cells){0};
}
