/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "broad/bvh.h"
#include "geom/clip.h"
#include "geom/mass.h"
#include "ice/blocks.h"

/* Mean number of sites in a cell of the search grid. */
#define SITES_PER_CELL 3.0
/* Relative tolerance of the filled volume: far below the accuracy of any measured porosity, above the
 * rounding of volumes. */
#define FILL_TOL 1e-10
#define FILL_MAX_ERROR 0.1 /* largest relative error that blocks vanishing together may leave */

enum { STEPS = 80, MAX_ROUNDS = 12, TRIES = 100000 };

double fl_blocks_volume(const fl_poly *p)
{
    double six = 0.0;
    for (int32_t f = 0; f < p->nf; f++)
        six += v3_dot(fl_poly_face_area_vector(p, f), v3_sub(p->v[p->loop[p->first[f]]], p->v[0]));
    return six / 3.0;
}

static int contains_point(const fl_poly *p, fl_vec3 x)
{
    for (int32_t f = 0; f < p->nf; f++)
        if (v3_dot(p->n[f], x) > p->c[f]) return 0;
    return 1;
}

/* --- sites ---------------------------------------------------------------------------------------------- */

static int draw_sites(int32_t n, uint64_t seed, int64_t first, const fl_poly *region, fl_vec3 *site,
                      fl_err *err)
{
    const fl_aabb box = fl_poly_aabb(region);
    for (int32_t i = 0; i < n; i++) {
        fl_rng g = fl_rng_of(seed, first + i, FL_RNG_SITE);
        int tries = 0;
        do {
            site[i].x = fl_rng_in(&g, box.lo.x, box.hi.x);
            site[i].y = fl_rng_in(&g, box.lo.y, box.hi.y);
            site[i].z = fl_rng_in(&g, box.lo.z, box.hi.z);
        } while (!contains_point(region, site[i]) && ++tries < TRIES);
        if (tries == TRIES) return fl_fail(err, FL_NUMERIC, "a region fills next to nothing of its box");
    }
    return 0;
}

/* Sites sorted by grid cells: those of cell k are order[first[k] .. first[k + 1]). */
struct grid {
    fl_vec3 lo;
    double step;
    int32_t m[3], *first, *order;
};

static int32_t grid_index(double x, double lo, double step, int32_t m)
{
    const double t = floor((x - lo) / step);
    return t < 0.0 ? 0 : t >= m ? m - 1 : (int32_t)t;
}

static void grid_cell_of(const struct grid *g, fl_vec3 x, int32_t at[3])
{
    at[0] = grid_index(x.x, g->lo.x, g->step, g->m[0]);
    at[1] = grid_index(x.y, g->lo.y, g->step, g->m[1]);
    at[2] = grid_index(x.z, g->lo.z, g->step, g->m[2]);
}

static int32_t grid_cell_number(const struct grid *g, const int32_t at[3])
{
    return (at[2] * g->m[1] + at[1]) * g->m[0] + at[0];
}

static int grid_build(struct grid *g, int32_t n, const fl_vec3 *site, fl_aabb box, double volume, fl_err *err)
{
    const double size[3] = {box.hi.x - box.lo.x, box.hi.y - box.lo.y, box.hi.z - box.lo.z};
    int32_t cells = 1;
    g->lo = box.lo;
    g->step = cbrt(SITES_PER_CELL * volume / n);
    for (int k = 0; k < 3; k++) {
        /* a long thin region has few sites in its box: limit the number of grid cells */
        g->m[k] = (int32_t)fmin(fmax(1.0, ceil(size[k] / g->step)), 512.0);
        g->step = fmax(g->step, size[k] / 512.0);
    }
    for (int k = 0; k < 3; k++) {
        g->m[k] = (int32_t)fmax(1.0, ceil(size[k] / g->step));
        cells *= g->m[k];
    }
    g->first = fl_alloc((int64_t)cells + 2, sizeof *g->first, err);
    g->order = fl_alloc(n, sizeof *g->order, err);
    if (!g->first || !g->order) return -1;
    for (int32_t i = 0; i < n; i++) {
        int32_t at[3];
        grid_cell_of(g, site[i], at);
        g->first[grid_cell_number(g, at) + 2]++;
    }
    for (int32_t k = 2; k <= cells; k++) g->first[k] += g->first[k - 1];
    for (int32_t i = 0; i < n; i++) {
        int32_t at[3];
        grid_cell_of(g, site[i], at);
        g->order[g->first[grid_cell_number(g, at) + 1]++] = i;
    }
    return 0;
}

static void grid_free(struct grid *g)
{
    free(g->first);
    free(g->order);
}

/* --- cells ---------------------------------------------------------------------------------------------- */

struct neighbour {
    double distance;
    int32_t j;
};

static int by_distance(const void *a, const void *b)
{
    const struct neighbour *p = a, *q = b;
    if (p->distance != q->distance) return (p->distance > q->distance) - (p->distance < q->distance);
    return (p->j > q->j) - (p->j < q->j);
}

/* Collect the sites in the grid cells at a distance of exactly `ring` cells in the maximum norm, nearest
 * first. */
static int collect_ring(const struct grid *g, const fl_vec3 *site, int32_t i, int32_t ring,
                        struct neighbour **list, int32_t *cap, int32_t *n, fl_err *err)
{
    int32_t at[3], to[3];
    grid_cell_of(g, site[i], at);
    *n = 0;
    for (to[2] = at[2] - ring; to[2] <= at[2] + ring; to[2]++)
        for (to[1] = at[1] - ring; to[1] <= at[1] + ring; to[1]++)
            for (to[0] = at[0] - ring; to[0] <= at[0] + ring; to[0]++) {
                int far = 0, out = 0;
                for (int k = 0; k < 3; k++) {
                    far = far > abs(to[k] - at[k]) ? far : abs(to[k] - at[k]);
                    out |= to[k] < 0 || to[k] >= g->m[k];
                }
                if (out || far < ring) continue;
                for (int32_t k = g->first[grid_cell_number(g, to)]; k < g->first[grid_cell_number(g, to) + 1];
                     k++) {
                    const int32_t j = g->order[k];
                    if (j == i) continue;
                    if (fl_grow(list, cap, (int64_t)*n + 1, sizeof **list, err)) return -1;
                    (*list)[(*n)++] = (struct neighbour){v3_norm(v3_sub(site[j], site[i])), j};
                }
            }
    if (*n) qsort(*list, (size_t)*n, sizeof **list, by_distance);
    return 0;
}

static double farthest_corner(const fl_poly *p, fl_vec3 x)
{
    double r = 0.0;
    for (int32_t v = 0; v < p->nv; v++) r = fmax(r, v3_norm2(v3_sub(p->v[v], x)));
    return sqrt(r);
}

static int cut_cell(fl_poly *cell, const fl_poly *region, const struct grid *g, const fl_vec3 *site,
                    int32_t i, fl_err *err)
{
    const int32_t most =
        g->m[0] > g->m[1] ? (g->m[0] > g->m[2] ? g->m[0] : g->m[2]) : (g->m[1] > g->m[2] ? g->m[1] : g->m[2]);
    struct neighbour *list = NULL;
    int32_t cap = 0, n;
    double reach;
    int rc = -1;
    if (fl_poly_copy(cell, region, err)) return -1;
    reach = 2.0 * farthest_corner(cell, site[i]);
    /* sites beyond a ring of the grid are at least that many steps away */
    for (int32_t ring = 0; ring <= most && (ring - 1) * g->step < reach; ring++) {
        if (collect_ring(g, site, i, ring, &list, &cap, &n, err)) goto done;
        for (int32_t k = 0; k < n && list[k].distance < reach; k++) {
            const fl_vec3 o = site[list[k].j], d = v3_scale(1.0 / list[k].distance, v3_sub(o, site[i]));
            const int32_t nv = cell->nv;
            if (fl_poly_cut(cell, d, v3_dot(d, v3_lerp(site[i], o, 0.5)), err)) goto done;
            if (cell->nv == 0) {
                fl_fail(err, FL_NUMERIC, "the cell of block %d vanishes: another site is too near", i);
                goto done;
            }
            if (cell->nv != nv || k % 8 == 0) reach = 2.0 * farthest_corner(cell, site[i]);
        }
        reach = 2.0 * farthest_corner(cell, site[i]);
    }
    rc = 0;
done:
    free(list);
    return rc;
}

static void free_polys(int32_t n, fl_poly *p)
{
    for (int32_t i = 0; p && i < n; i++) fl_poly_free(&p[i]);
}

static int cut_cells(fl_blocks *b, const fl_poly *region, fl_err *err)
{
    struct grid g = {0};
    int32_t bad = INT32_MAX;
    free_polys(b->n, b->cell);
    if (grid_build(&g, b->n, b->site, fl_poly_aabb(region), b->region_volume, err)) {
        grid_free(&g);
        return -1;
    }
#pragma omp parallel for schedule(dynamic, 8)
    for (int32_t i = 0; i < b->n; i++) {
        fl_err why = {0};
        if (cut_cell(&b->cell[i], region, &g, b->site, i, &why) == 0) continue;
#pragma omp critical
        if (i < bad) {
            bad = i;
            *err = why;
        }
    }
    grid_free(&g);
    return bad < INT32_MAX ? -1 : 0;
}

int fl_blocks_cells(fl_blocks *out, const fl_poly *region, int32_t n, uint64_t seed, int64_t first,
                    int smooth, fl_err *err)
{
    fl_blocks b = {.n = n, .region_volume = fl_blocks_volume(region)};
    int rc = -1;
    b.site = fl_alloc(n, sizeof *b.site, err);
    b.cell = fl_alloc(n, sizeof *b.cell, err);
    b.core = fl_alloc(n, sizeof *b.core, err);
    b.volume = fl_alloc(n, sizeof *b.volume, err);
    if (!b.site || !b.cell || !b.core || !b.volume) goto done;
    if (draw_sites(n, seed, first, region, b.site, err) || cut_cells(&b, region, err)) goto done;
    for (int k = 0; k < smooth; k++) {
        for (int32_t i = 0; i < n; i++) {
            fl_mass m;
            if (fl_mass_of(&m, &b.cell[i], 0.0, err)) goto done;
            b.site[i] = m.centre;
        }
        if (cut_cells(&b, region, err)) goto done;
    }
    for (int32_t i = 0; i < n; i++) b.volume[i] = fl_blocks_volume(&b.cell[i]);
    b.cells_volume = fl_parallel_sum(b.volume, n);
    *out = b;
    b = (fl_blocks){0};
    rc = 0;
done:
    fl_blocks_free(&b);
    return rc;
}

/* --- blocks --------------------------------------------------------------------------------------------- */

/* Offset a polyhedron.  Returns 1 if nothing with faces remains, which means that there is no block. */
static int offset_poly(fl_poly *out, const fl_poly *in, double r, fl_err *err)
{
    fl_err why = {0};
    if (r == 0.0) return fl_poly_copy(out, in, err);
    if (fl_poly_offset(out, in, r, &why) == 0) return 0;
    return why.code == FL_SYSTEM ? fl_fail(err, FL_SYSTEM, "%s", why.text) : 1;
}

/* A core has a least width between two parallel planes, over the dilation radius and over its size;
 * otherwise it would be a sheet. */
static const double THICK_OF_RADIUS = 1e-2, THICK_OF_SIZE = 1e-4;

static int is_too_thin(const fl_poly *p, double radius)
{
    const double least = fmax(THICK_OF_RADIUS * radius, THICK_OF_SIZE * p->size);
    for (int32_t f = 0; f < p->nf; f++) {
        double low = INFINITY;
        for (int32_t v = 0; v < p->nv; v++) low = fmin(low, v3_dot(p->n[f], p->v[v]));
        if (p->c[f] - low < least) return 1;
    }
    return 0;
}

/* Largest distance of corners of p beyond the faces of the cell moved inward by d. */
static double max_excess(const fl_poly *cell, const fl_poly *p, double d)
{
    double most = -INFINITY;
    for (int32_t f = 0; f < cell->nf; f++)
        for (int32_t v = 0; v < p->nv; v++) most = fmax(most, v3_dot(cell->n[f], p->v[v]) - cell->c[f] + d);
    return most;
}

/* Make the core of a cell for an inset, and the volume of its outer block; nv = 0 if there is no room. */
static int make_block(const fl_poly *cell, double inset, double radius, fl_poly *core, double *volume,
                      fl_err *err)
{
    const double spare = (1.0 - FL_BLOCKS_CLEARANCE) * inset + 1e-12 * cell->size;
    double deeper = 0.0;
    *volume = 0.0;
    fl_poly_free(core);
    for (int k = 0; k < MAX_ROUNDS; k++) {
        fl_poly c = {0}, outer = {0};
        double out;
        int rc = offset_poly(&c, cell, -(inset + radius + deeper), err);
        if (rc == 0) rc = is_too_thin(&c, radius);
        if (rc == 0) rc = offset_poly(&outer, &c, radius, err);
        if (rc) {
            fl_poly_free(&c);
            return rc < 0 ? -1 : 0;
        }
        out = max_excess(cell, &outer, inset);
        if (out <= spare) {
            *volume = fl_blocks_volume(&outer);
            *core = c;
            fl_poly_free(&outer);
            return 0;
        }
        deeper += out - 0.5 * spare;
        fl_poly_free(&c);
        fl_poly_free(&outer);
    }
    return 0;
}

static int shrink_cells(fl_blocks *b, double inset, double radius, double *sum, fl_err *err)
{
    int32_t bad = INT32_MAX;
#pragma omp parallel for schedule(dynamic, 8)
    for (int32_t i = 0; i < b->n; i++) {
        fl_err why = {0};
        if (make_block(&b->cell[i], inset, radius, &b->core[i], &b->volume[i], &why) == 0) continue;
#pragma omp critical
        if (i < bad) {
            bad = i;
            *err = why;
        }
    }
    *sum = fl_parallel_sum(b->volume, b->n);
    return bad < INT32_MAX ? -1 : 0;
}

int fl_blocks_shrink(fl_blocks *b, double solid, double radius, fl_err *err)
{
    const double want = solid * b->region_volume;
    double lo = 0.0, hi = cbrt(b->region_volume / b->n), over_lo, over_hi, over, sum, inset = 0.0;
    if (shrink_cells(b, lo, radius, &sum, err)) return -1;
    over_lo = sum - want;
    if (over_lo < 0.0)
        return fl_fail(
            err, FL_INPUT,
            "blocks of dilation radius %.4g m fill %.4g of their region at most, %.10g is requested: a "
            "smaller radius or larger blocks are needed",
            radius, sum / b->region_volume, solid);
    over_hi = -want; /* an inset of the size of a cell leaves nothing */
    over = over_lo;
    for (int step = 0; step < STEPS && fabs(over) > FILL_TOL * want; step++) {
        const double line = lo + (hi - lo) * (over_lo / (over_lo - over_hi));
        inset = step % 3 == 2 || !(line > lo && line < hi) ? 0.5 * (lo + hi) : line;
        if (shrink_cells(b, inset, radius, &sum, err)) return -1;
        over = sum - want;
        if (over > 0.0) {
            lo = inset;
            over_lo = over;
        } else {
            hi = inset;
            over_hi = over;
        }
    }
    if (fabs(over) > FILL_MAX_ERROR * want)
        return fl_fail(
            err, FL_INPUT,
            "blocks of dilation radius %.4g m vanish, many at a time, where they fill %.4g of their "
            "region, %.10g is requested: a smaller radius is needed",
            radius, (want + over_lo) / b->region_volume, solid);
    b->inset = inset;
    b->solid_volume = sum;
    b->blockless = 0;
    for (int32_t i = 0; i < b->n; i++) b->blockless += b->core[i].nv == 0;
    return 0;
}

static int is_separated(const fl_poly *a, const fl_poly *c, fl_vec3 d)
{
    double most = -INFINITY, least = INFINITY;
    for (int32_t v = 0; v < a->nv; v++) most = fmax(most, v3_dot(d, a->v[v]));
    for (int32_t v = 0; v < c->nv; v++) least = fmin(least, v3_dot(d, c->v[v]));
    return most < least;
}

int fl_blocks_overlaps(const fl_blocks *b, double radius, int64_t *pairs, fl_err *err)
{
    fl_poly *outer = fl_alloc(b->n, sizeof *outer, err);
    fl_aabb *box = fl_alloc(b->n, sizeof *box, err);
    int32_t *near = NULL, cap = 0, got;
    fl_bvh tree = {0};
    int rc = -1;
    *pairs = 0;
    if (!outer || !box) goto done;
    for (int32_t i = 0; i < b->n; i++) {
        box[i] = (fl_aabb){b->site[i], b->site[i]}; /* empty box, meets its own site only */
        if (b->core[i].nv == 0) continue;
        if (offset_poly(&outer[i], &b->core[i], radius, err) < 0) goto done;
        box[i] = fl_poly_aabb(&outer[i]);
    }
    if (fl_bvh_build(&tree, box, b->n, err)) goto done;
    for (int32_t i = 0; i < b->n; i++) {
        while ((got = fl_bvh_query(&tree, box, box[i], near, cap)) > cap)
            if (fl_grow(&near, &cap, got, sizeof *near, err)) goto done;
        for (int32_t k = 0; k < got; k++)
            if (near[k] > i && outer[i].nv && outer[near[k]].nv)
                *pairs += !is_separated(&outer[i], &outer[near[k]], v3_sub(b->site[near[k]], b->site[i]));
    }
    rc = 0;
done:
    free_polys(b->n, outer);
    free(outer);
    free(box);
    free(near);
    fl_bvh_free(&tree);
    return rc;
}

void fl_blocks_free(fl_blocks *b)
{
    free_polys(b->n, b->cell);
    free_polys(b->n, b->core);
    free(b->site);
    free(b->cell);
    free(b->core);
    free(b->volume);
    *b = (fl_blocks){0};
}
