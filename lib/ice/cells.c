/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/mem.h"
#include "base/rng.h"
#include "ice/cells.h"
#include "shim/cgal_voronoi.h"

void fl_cells_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site)
{
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, i, FL_RNG_SITE);
        site[i].x = fl_rng_in(&g, lo.x, hi.x);
        site[i].y = fl_rng_in(&g, lo.y, hi.y);
    }
}

/* What is nearer to site i than to site j.  Always computed from the lower to the higher index, so that both
 * cells see one line. */
static fl_side bisector(const fl_vec2 *site, int32_t i, int32_t j)
{
    const fl_vec2 a = site[i < j ? i : j], b = site[i < j ? j : i];
    const double dx = b.x - a.x, dy = b.y - a.y, s = (i < j ? 1.0 : -1.0) / hypot(dx, dy);
    return (fl_side){s * dx, s * dy, s * (dx * (0.5 * (a.x + b.x)) + dy * (0.5 * (a.y + b.y))), j};
}

/* A rectangle cut k times has at most 4 + k sides; that is the room each cell gets first. */
static int32_t room(const int32_t *near_first, int32_t i) { return near_first[i] + 4 * i; }

int fl_cells_build(fl_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi, fl_err *err)
{
    fl_cells c = {.n = n};
    int32_t *near_first = fl_alloc((int64_t)n + 1, sizeof *near_first, err), *near = NULL;
    int rc = -1;
    c.first = fl_alloc((int64_t)n + 1, sizeof *c.first, err);
    if (!near_first || !c.first || fl_cgal_neighbours(n, site, near_first, &near, err)) goto done;
    c.side = fl_alloc(room(near_first, n), sizeof *c.side, err);
    c.v = fl_alloc(room(near_first, n), sizeof *c.v, err);
    if (!c.side || !c.v) goto done;
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < n; i++) {
        fl_vec2 *v = c.v + room(near_first, i);
        fl_side *side = c.side + room(near_first, i);
        int32_t m = 4;
        fl_polygon_rectangle(lo, hi, v, side);
        for (int32_t k = near_first[i]; k < near_first[i + 1] && m > 0; k++)
            m = fl_polygon_cut(m, v, side, bisector(site, i, near[k]));
        c.first[i + 1] = m;
    }
    for (int32_t i = 0; i < n; i++) { /* close the gaps; the target never passes the source */
        const int32_t m = c.first[i + 1], from = room(near_first, i);
        if (m < 3) {
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
    free(near_first);
    free(near);
    fl_cells_free(&c);
    return rc;
}

void fl_cells_centroids(const fl_cells *c, fl_vec2 *site)
{
#pragma omp parallel for schedule(static)
    for (int32_t i = 0; i < c->n; i++)
        site[i] = fl_polygon_centroid(c->first[i + 1] - c->first[i], c->v + c->first[i]);
}

void fl_cells_free(fl_cells *c)
{
    free(c->first);
    free(c->side);
    free(c->v);
    *c = (fl_cells){0};
}
