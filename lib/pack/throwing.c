/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "pack/throwing.h"
#include <math.h>
#include <string.h>
#include "base/array.h"
#include "base/rng.h"

enum { TRIES = 1000, PLACES = 1000000, HALVINGS = 8, LEVELS_MAX = 40, CELLS_MAX = 1 << 24 };

/* Bodies of a factor 2 in size, in cells as wide as the largest of them; cells by a hash table. */
typedef struct {
    double cell, most; /* width; largest radius [m] */
    int32_t first, end;
    int32_t mask;
    int32_t *head; /* [mask + 1] body + 1, 0: none */
} grid_level;

typedef struct {
    grid_level level[LEVELS_MAX];
    int levels;
    int32_t *next;                 /* [n] body + 1 after this one in its cell */
    int32_t period[LEVELS_MAX][3]; /* cells of a periodic direction, 0: not periodic */
} grid;

static void free_grid(grid *g)
{
    for (int k = 0; k < g->levels; k++) free(g->level[k].head);
    free(g->next);
    *g = (grid){.levels = 0};
}

static int make_grid(grid *g, const fl_packing *p, const fl_pack_region *r, double s, fl_err *err)
{
    const double lo[3] = {r->lo.x, r->lo.y, r->lo.z}, hi[3] = {r->hi.x, r->hi.y, r->hi.z};
    *g = (grid){.levels = 0};
    if (!(g->next = fl_alloc(p->n, sizeof *g->next, err))) return -1;
    for (int32_t i = 0; i < p->n;) {
        grid_level *l = &g->level[g->levels];
        *l = (grid_level){.most = s * p->bound[i], .cell = 2.0 * s * p->bound[i], .first = i, .mask = 63};
        while (i < p->n && (s * p->bound[i] > 0.5 * l->most || g->levels == LEVELS_MAX - 1)) i++;
        l->end = i;
        while (l->mask < 2 * (l->end - l->first) && l->mask < CELLS_MAX) l->mask = 2 * l->mask + 1;
        for (int k = 0; k < 3; k++) { /* whole cells in a period */
            const double cells = floor((hi[k] - lo[k]) / l->cell);
            g->period[g->levels][k] = r->periodic[k] ? (int32_t)fmax(cells, 1.0) : 0;
        }
        l->head = fl_alloc((int64_t)l->mask + 1, sizeof *l->head, err);
        g->levels++;
        if (!l->head) {
            free_grid(g);
            return -1;
        }
    }
    return 0;
}

/* Cell coordinate of x along axis k. */
static int32_t cell_at(const grid *g, int level, const fl_pack_region *r, int k, double x)
{
    const double lo = v3_at(r->lo, k), hi = v3_at(r->hi, k);
    const int32_t period = g->period[level][k];
    return (int32_t)floor(period ? (x - lo) / (hi - lo) * period : (x - lo) / g->level[level].cell);
}

static uint32_t hash_cell(int32_t a, int32_t b, int32_t c)
{
    return (uint32_t)a * 73856093u ^ (uint32_t)b * 19349663u ^ (uint32_t)c * 83492791u;
}

static int32_t wrap_cell(int32_t c, int32_t period) { return period ? (c % period + period) % period : c; }

/* True if a ball about x of radius R overlaps a body that is placed. */
static int overlaps_level(const grid *g, int level, const fl_packing *p, const fl_pack_region *r, fl_vec3 x,
                          double R, double s)
{
    const grid_level *l = &g->level[level];
    int32_t from[3], to[3];
    const double reach = R + l->most;
    for (int k = 0; k < 3; k++) {
        from[k] = cell_at(g, level, r, k, v3_at(x, k) - reach);
        to[k] = cell_at(g, level, r, k, v3_at(x, k) + reach);
        if (g->period[level][k] && to[k] - from[k] >= g->period[level][k])
            from[k] = 0, to[k] = g->period[level][k] - 1;
    }
    for (int32_t a = from[0]; a <= to[0]; a++)
        for (int32_t b = from[1]; b <= to[1]; b++)
            for (int32_t c = from[2]; c <= to[2]; c++) {
                const uint32_t h =
                    hash_cell(wrap_cell(a, g->period[level][0]), wrap_cell(b, g->period[level][1]),
                              wrap_cell(c, g->period[level][2]));
                for (int32_t j = l->head[h & (uint32_t)l->mask]; j; j = g->next[j - 1]) {
                    const double both = R + s * p->bound[j - 1];
                    if (v3_norm2(fl_region_wrap(r, v3_sub(x, p->x[j - 1]))) < both * both) return 1;
                }
            }
    return 0;
}

static void place_body(grid *g, int level, const fl_packing *p, const fl_pack_region *r, int32_t i)
{
    grid_level *l = &g->level[level];
    int32_t c[3];
    for (int k = 0; k < 3; k++)
        c[k] = wrap_cell(cell_at(g, level, r, k, v3_at(p->x[i], k)), g->period[level][k]);
    int32_t *head = &l->head[hash_cell(c[0], c[1], c[2]) & (uint32_t)l->mask];
    g->next[i] = *head;
    *head = i + 1;
}

/* A random place for body i.  1, 0 where none is free, -1 where none is inside the region. */
static int find_place(const grid *g, int level, fl_packing *p, const fl_pack_region *r,
                      const fl_pack_layers *layers, enum fl_throw how, uint64_t seed, int32_t i, double s)
{
    fl_rng rng = fl_rng_of(seed, i, FL_RNG_SCATTER);
    const double R = s * p->bound[i];
    int inside = 0;
    for (int32_t k = 0; k < PLACES && inside < TRIES; k++) {
        const double a = fl_rng_unit(&rng), b = fl_rng_unit(&rng), c = fl_rng_unit(&rng);
        const fl_vec3 x = v3(r->lo.x + a * (r->hi.x - r->lo.x), r->lo.y + b * (r->hi.y - r->lo.y),
                             r->lo.z + c * (r->hi.z - r->lo.z));
        if (fl_region_distance(r, x, INFINITY) < R) continue;
        if (layers && fl_pack_layers_find(layers, x) != layers->of[i]) continue;
        inside++;
        int hit = 0;
        for (int l = 0; how == FL_THROW_REJECTION && !hit && l <= level; l++)
            hit = overlaps_level(g, l, p, r, x, R, s);
        if (hit) continue;
        p->x[i] = x;
        return 1;
    }
    return inside ? 0 : -1;
}

int fl_throw_bodies(fl_packing *p, const fl_pack_region *r, const fl_pack_layers *layers, enum fl_throw how,
                    uint64_t seed, int *halved, fl_err *err)
{
    double s = 0.5;
    while (s * fl_packing_most(p) > 0.7 * r->inradius) s *= 0.5;
    for (*halved = 0; *halved <= HALVINGS; ++*halved, s *= 0.5) {
        grid g;
        int32_t i = 0;
        int level = 0, got = 1;
        if (make_grid(&g, p, r, s, err)) return -1;
        for (; i < p->n && got > 0; i++) {
            while (i >= g.level[level].end) level++;
            got = find_place(&g, level, p, r, layers, how, seed, i, s);
            if (got > 0) place_body(&g, level, p, r, i);
        }
        free_grid(&g);
        if (got > 0) {
            p->s = s;
            return 0;
        }
    }
    return fl_fail(err, FL_INPUT, "%d bodies find no free place in the region even at %.3g of their size",
                   p->n, s);
}
