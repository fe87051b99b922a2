/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/mem.h"
#include "geom/weld.h"

static const double SHARE = 1e-6;    /* default tolerance over diagonal; see weld.h */
static const double NO_TOL = 1e-15;  /* cells of less than this would not fit in 53 bits */
static const double TOO_FAR = 1e150; /* squares of lengths must not overflow */

static uint64_t mix(uint64_t h)
{
    h ^= h >> 29;
    h *= UINT64_C(0xbf58476d1ce4e5b9);
    return h ^ h >> 32;
}

static uint64_t hash_place(fl_vec3 x)
{
    const double c[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* -0 is 0 */
    uint64_t u[3];
    memcpy(u, c, sizeof u);
    return mix(u[0] * UINT64_C(0x9e3779b97f4a7c15) + mix(u[1] * UINT64_C(0xc2b2ae3d27d4eb4f) + mix(u[2])));
}

/* to[v] = first vertex at the same place: an open table of those, at most half full. */
static int merge_equal(const fl_part *p, int32_t *to, fl_err *err)
{
    uint64_t mask = 16;
    int32_t *table;
    while (mask < 2 * (uint64_t)p->nv) mask *= 2;
    table = fl_alloc((int64_t)mask, sizeof *table, err); /* vertex plus one, 0 for free */
    if (!table) return -1;
    mask--;
    for (int32_t v = 0; v < p->nv; v++) {
        const fl_vec3 x = p->v[v];
        uint64_t k = hash_place(x) & mask;
        for (; table[k]; k = (k + 1) & mask) {
            const fl_vec3 y = p->v[table[k] - 1];
            if (x.x == y.x && x.y == y.y && x.z == y.z) break;
        }
        if (!table[k]) table[k] = v + 1;
        to[v] = table[k] - 1;
    }
    free(table);
    return 0;
}

/* A hash of cells of side 2 tol, so that all within tol of a point lies in at most eight of them. */
typedef struct {
    fl_vec3 lo;
    double cell;
    uint64_t mask;
    int32_t *head, *next; /* chains of vertices; -1 ends one */
} grid;

static uint64_t slot(const grid *g, int64_t ix, int64_t iy, int64_t iz)
{
    const uint64_t h = (uint64_t)ix * UINT64_C(0x9e3779b97f4a7c15) +
                       (uint64_t)iy * UINT64_C(0xc2b2ae3d27d4eb4f) +
                       (uint64_t)iz * UINT64_C(0x165667b19e3779f9);
    return mix(h) & g->mask;
}

static int64_t cell_of(double x, double lo, double cell) { return (int64_t)floor((x - lo) / cell); }

/* Nearest vertex in the grid within tol of x, the lowest index on a tie; -1 for none. */
static int32_t nearest(const grid *g, const fl_part *p, fl_vec3 x, double tol, double *distance)
{
    const int64_t x0 = cell_of(x.x - tol, g->lo.x, g->cell), x1 = cell_of(x.x + tol, g->lo.x, g->cell);
    const int64_t y0 = cell_of(x.y - tol, g->lo.y, g->cell), y1 = cell_of(x.y + tol, g->lo.y, g->cell);
    const int64_t z0 = cell_of(x.z - tol, g->lo.z, g->cell), z1 = cell_of(x.z + tol, g->lo.z, g->cell);
    int32_t best = -1;
    double least = tol;
    for (int64_t i = x0; i <= x1; i++)
        for (int64_t j = y0; j <= y1; j++)
            for (int64_t k = z0; k <= z1; k++)
                for (int32_t v = g->head[slot(g, i, j, k)]; v >= 0; v = g->next[v]) {
                    const double d = v3_norm(v3_sub(p->v[v], x));
                    if (d > least || (d == least && best >= 0 && v >= best)) continue;
                    least = d;
                    best = v;
                }
    *distance = least;
    return best;
}

static int merge_near(const fl_part *p, int32_t *to, fl_vec3 lo, fl_weld *w, fl_err *err)
{
    grid g = {.lo = lo, .cell = 2.0 * w->tol, .mask = 16};
    int32_t *mem;
    while (g.mask < 2 * (uint64_t)p->nv) g.mask *= 2;
    mem = fl_alloc((int64_t)g.mask + p->nv, sizeof *mem, err);
    if (!mem) return -1;
    g.head = mem;
    g.next = mem + g.mask;
    for (uint64_t k = 0; k < g.mask; k++) g.head[k] = -1;
    g.mask--;
    for (int32_t v = 0; v < p->nv; v++) {
        double d;
        int32_t u;
        if (to[v] != v) {
            to[v] = to[to[v]]; /* its twin came first, and may have moved since */
            continue;
        }
        u = nearest(&g, p, p->v[v], w->tol, &d);
        if (u >= 0) {
            to[v] = u;
            if (d > w->moved) w->moved = d;
        } else {
            const uint64_t k = slot(&g, cell_of(p->v[v].x, lo.x, g.cell), cell_of(p->v[v].y, lo.y, g.cell),
                                    cell_of(p->v[v].z, lo.z, g.cell));
            g.next[v] = g.head[k];
            g.head[k] = v;
        }
    }
    free(mem);
    return 0;
}

/* Put the vertices in the order of their first use, and drop the rest; index[nv] is scratch.  Returns how
 * many were dropped. */
static int32_t renumber(fl_part *p, int32_t *index, fl_vec3 *scratch)
{
    const int32_t before = p->nv;
    int32_t n = 0;
    for (int32_t v = 0; v < p->nv; v++) index[v] = -1;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) {
            int32_t *v = &p->t[t].v[k];
            if (index[*v] < 0) {
                index[*v] = n;
                scratch[n++] = p->v[*v];
            }
            *v = index[*v];
        }
    for (int32_t v = 0; v < n; v++) p->v[v] = v3_add(scratch[v], v3(0, 0, 0)); /* -0 becomes 0 */
    p->nv = n;
    return before - n;
}

static double shortest_edge(const fl_part *p)
{
    double least = INFINITY;
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) {
            const double l = v3_norm(v3_sub(p->v[p->t[t].v[k]], p->v[p->t[t].v[(k + 1) % 3]]));
            if (l > 0.0 && l < least) least = l;
        }
    return least;
}

static int choose_tol(const fl_part *p, double tol, double diagonal, fl_weld *w, fl_err *err)
{
    const double edge = shortest_edge(p);
    if (tol > edge)
        return fl_fail(
            err, FL_INPUT,
            "part \"%.60s\": the welding tolerance %g m is above the shortest edge, %g m: less was wanted",
            p->name ? p->name : "", tol, edge);
    w->tol = tol >= 0.0 ? tol : fmin(SHARE * diagonal, 0.5 * edge);
    if (w->tol < NO_TOL * diagonal) w->tol = 0.0;
    return 0;
}

int fl_part_weld(fl_part *p, double tol, fl_weld *w, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(p);
    const double diagonal = p->nt ? v3_norm(v3_sub(box.hi, box.lo)) : 0.0;
    int32_t *to = NULL, kept = 0;
    fl_vec3 *scratch = NULL;
    int rc = -1;
    *w = (fl_weld){0};
    if (!(diagonal < TOO_FAR)) {
        return fl_fail(err, FL_INPUT, "part \"%.60s\": a box of %g m across is too large to measure",
                       p->name ? p->name : "", diagonal);
    }
    if (choose_tol(p, tol, diagonal, w, err)) return -1;
    scratch = fl_alloc(p->nv, sizeof *scratch, err);
    to = scratch ? fl_alloc(p->nv, sizeof *to, err) : NULL;
    if (!to) goto done;
    w->unused = renumber(p, to, scratch); /* the order of first use decides who stays */
    if (merge_equal(p, to, err) || (w->tol > 0.0 && merge_near(p, to, box.lo, w, err))) goto done;
    for (int32_t v = 0; v < p->nv; v++) w->merged += to[v] != v;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t a = to[p->t[t].v[0]], b = to[p->t[t].v[1]], c = to[p->t[t].v[2]];
        if (a != b && b != c && c != a) p->t[kept++] = (fl_tri){{a, b, c}};
    }
    w->collapsed = p->nt - kept;
    p->nt = kept;
    renumber(p, to, scratch);
    rc = 0;
done:
    free(to);
    free(scratch);
    return rc;
}
