/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <string.h>
#include "base/array.h"
#include "geom/weld.h"

static const double SHARE = 1e-6;    /* default tolerance relative to the diagonal, see weld.h */
static const double NO_TOL = 1e-15;  /* smaller cells would need more than 53 bits */
static const double TOO_FAR = 1e150; /* squares of lengths must not overflow */

static uint64_t mix_bits(uint64_t h)
{
    h ^= h >> 29;
    h *= UINT64_C(0xbf58476d1ce4e5b9);
    return h ^ h >> 32;
}

static uint64_t hash_point(fl_vec3 x)
{
    const double c[3] = {x.x + 0.0, x.y + 0.0, x.z + 0.0}; /* -0 becomes 0 */
    uint64_t u[3];
    memcpy(u, c, sizeof u);
    return mix_bits(u[0] * UINT64_C(0x9e3779b97f4a7c15) +
                    mix_bits(u[1] * UINT64_C(0xc2b2ae3d27d4eb4f) + mix_bits(u[2])));
}

/* Cell size in tolerances, where edges are longer: most points then have all neighbours within tol in one
 * cell, and few vertices share a cell. */
static const double CELL_TOLERANCES = 64.0;

/* Kept vertices by their cell, and merged vertices by their coordinates if no kept vertex has the same
 * ones. */
typedef struct {
    fl_vec3 lo;
    double cells_per_length; /* 0 when only equal coordinates are merged */
    uint64_t mask;
    int32_t *head, *merged_head; /* chains of vertices, ended by -1; merged_head is NULL until needed */
    int32_t *next;
} vertex_grid;

static uint64_t slot_of_cell(const vertex_grid *g, int64_t ix, int64_t iy, int64_t iz)
{
    const uint64_t h = (uint64_t)ix * UINT64_C(0x9e3779b97f4a7c15) +
                       (uint64_t)iy * UINT64_C(0xc2b2ae3d27d4eb4f) +
                       (uint64_t)iz * UINT64_C(0x165667b19e3779f9);
    return mix_bits(h) & g->mask;
}

/* Never falls as x rises: a point between two points lies in a cell between theirs. */
static int64_t cell_index(double x, double lo, double cells_per_length)
{
    const double c = (x - lo) * cells_per_length;
    const int64_t k = (int64_t)c;
    return k - (c < (double)k);
}

static uint64_t slot_of_point(const vertex_grid *g, fl_vec3 x)
{
    if (g->cells_per_length == 0.0) return hash_point(x) & g->mask;
    return slot_of_cell(g, cell_index(x.x, g->lo.x, g->cells_per_length),
                        cell_index(x.y, g->lo.y, g->cells_per_length),
                        cell_index(x.z, g->lo.z, g->cells_per_length));
}

static int same_point(fl_vec3 x, fl_vec3 y) { return x.x == y.x && x.y == y.y && x.z == y.z; }

/* The vertex of a chain with the coordinates x, -1 for none. */
static int32_t find_equal(const int32_t *head, const vertex_grid *g, uint64_t k, const fl_part *p, fl_vec3 x)
{
    int32_t v = head[k];
    while (v >= 0 && !same_point(p->v[v], x)) v = g->next[v];
    return v;
}

/* The nearest kept vertex within tol of x, the lowest index on a tie; -1 for none. */
static int32_t nearest_kept(const vertex_grid *g, const fl_part *p, fl_vec3 x, double tol, double *distance)
{
    const int64_t x0 = cell_index(x.x - tol, g->lo.x, g->cells_per_length),
                  x1 = cell_index(x.x + tol, g->lo.x, g->cells_per_length);
    const int64_t y0 = cell_index(x.y - tol, g->lo.y, g->cells_per_length),
                  y1 = cell_index(x.y + tol, g->lo.y, g->cells_per_length);
    const int64_t z0 = cell_index(x.z - tol, g->lo.z, g->cells_per_length),
                  z1 = cell_index(x.z + tol, g->lo.z, g->cells_per_length);
    int32_t best = -1;
    double least = tol;
    for (int64_t i = x0; i <= x1; i++)
        for (int64_t j = y0; j <= y1; j++)
            for (int64_t k = z0; k <= z1; k++)
                for (int32_t v = g->head[slot_of_cell(g, i, j, k)]; v >= 0; v = g->next[v]) {
                    const double d = v3_norm(v3_sub(p->v[v], x));
                    if (d > least || (d == least && best >= 0 && v >= best)) continue;
                    least = d;
                    best = v;
                }
    *distance = least;
    return best;
}

/* Records a merged vertex, since later vertices may have the same coordinates. */
static int record_merged(vertex_grid *g, int32_t v, fl_vec3 x, fl_err *err)
{
    const uint64_t k = hash_point(x) & g->mask;
    if (!g->merged_head) {
        g->merged_head = fl_alloc((int64_t)g->mask + 1, sizeof *g->merged_head, err);
        if (!g->merged_head) return -1;
        memset(g->merged_head, -1, (size_t)(g->mask + 1) * sizeof *g->merged_head);
    }
    g->next[v] = g->merged_head[k];
    g->merged_head[k] = v;
    return 0;
}

static int merge_vertex(vertex_grid *g, const fl_part *p, int32_t v, uint64_t own, int32_t *to, fl_weld *w,
                        fl_err *err)
{
    const fl_vec3 x = p->v[v];
    int32_t u = find_equal(g->head, g, own, p, x);
    double d;
    if (u < 0 && g->merged_head) u = find_equal(g->merged_head, g, hash_point(x) & g->mask, p, x);
    to[v] = u >= 0 ? to[u] : v;
    if (u >= 0) return 0;
    u = w->tol > 0.0 ? nearest_kept(g, p, x, w->tol, &d) : -1;
    if (u < 0) {
        g->next[v] = g->head[own];
        g->head[own] = v;
        return 0;
    }
    to[v] = u;
    w->moved = fmax(w->moved, d);
    return record_merged(g, v, x, err);
}

/* to[v]: the vertex that v becomes: that of the first vertex with the same coordinates, else the nearest
 * earlier vertex within tol, else v. */
static int merge_vertices(const fl_part *p, int32_t *to, fl_vec3 lo, double edge, fl_weld *w, fl_err *err)
{
    enum { AHEAD = 8 }; /* the chain heads are scattered in memory and are prefetched */
    vertex_grid g = {.lo = lo, .mask = 16};
    uint64_t slots[AHEAD] = {0};
    int rc = 0;
    if (w->tol > 0.0) g.cells_per_length = 1.0 / fmax(2.0 * w->tol, fmin(CELL_TOLERANCES * w->tol, edge));
    while (g.mask < 2 * (uint64_t)p->nv) g.mask *= 2;
    g.head = fl_alloc((int64_t)g.mask + p->nv, sizeof *g.head, err);
    if (!g.head) return -1;
    g.next = g.head + g.mask;
    memset(g.head, -1, (size_t)g.mask * sizeof *g.head);
    g.mask--;
    for (int64_t n = 0; rc == 0 && n < (int64_t)p->nv + AHEAD; n++) {
        const uint64_t own = slots[n % AHEAD]; /* of the vertex AHEAD before */
        if (n < p->nv) __builtin_prefetch(&g.head[slots[n % AHEAD] = slot_of_point(&g, p->v[n])]);
        if (n >= AHEAD) rc = merge_vertex(&g, p, (int32_t)(n - AHEAD), own, to, w, err);
    }
    free(g.head);
    free(g.merged_head);
    return rc;
}

/* Renumbers the vertices in the order of first use and drops the unused ones.  index[nv] is scratch.  Returns
 * the number of dropped vertices. */
static int32_t renumber_by_use(fl_part *p, int32_t *index, fl_vec3 *scratch)
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
    for (int32_t t = 0; t < p->nt; t++) {
        const fl_vec3 a = p->v[p->t[t].v[0]], b = p->v[p->t[t].v[1]], c = p->v[p->t[t].v[2]];
        const double l[3] = {v3_norm2(v3_sub(a, b)), v3_norm2(v3_sub(b, c)), v3_norm2(v3_sub(c, a))};
        for (int k = 0; k < 3; k++)
            if (l[k] > 0.0 && l[k] < least) least = l[k];
    }
    return sqrt(least);
}

static int choose_tol(const fl_part *p, double tol, double diagonal, double edge, fl_weld *w, fl_err *err)
{
    if (tol > edge)
        return fl_fail(err, FL_INPUT,
                       "part \"%.60s\": the welding tolerance %g m is above the shortest edge, %g m: a "
                       "smaller one is expected",
                       p->name ? p->name : "", tol, edge);
    w->tol = tol >= 0.0 ? tol : fmin(SHARE * diagonal, 0.5 * edge);
    if (w->tol < NO_TOL * diagonal) w->tol = 0.0;
    return 0;
}

/* True if a triangle has a repeated index. */
static int has_repeated(const fl_part *p)
{
    int any = 0;
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t *v = p->t[t].v;
        any |= v[0] == v[1] || v[1] == v[2] || v[2] == v[0];
    }
    return any;
}

int fl_part_weld(fl_part *p, double tol, fl_weld *w, fl_err *err)
{
    const fl_aabb box = fl_part_aabb(p);
    const double diagonal = p->nt ? v3_norm(v3_sub(box.hi, box.lo)) : 0.0;
    const double edge = shortest_edge(p);
    int32_t *to = NULL, kept = 0;
    fl_vec3 *scratch = NULL;
    int rc = -1;
    *w = (fl_weld){0};
    if (!(diagonal < TOO_FAR)) {
        return fl_fail(err, FL_INPUT, "part \"%.60s\": a box of %g m across is too large to measure",
                       p->name ? p->name : "", diagonal);
    }
    if (choose_tol(p, tol, diagonal, edge, w, err)) return -1;
    scratch = fl_alloc(p->nv, sizeof *scratch, err);
    to = scratch ? fl_alloc(p->nv, sizeof *to, err) : NULL;
    if (!to) goto done;
    w->unused = renumber_by_use(p, to, scratch); /* the order of first use decides which vertices are kept */
    if (merge_vertices(p, to, box.lo, edge, w, err)) goto done;
    for (int32_t v = 0; v < p->nv; v++) w->merged += to[v] != v;
    if (w->merged == 0 && !has_repeated(p)) {
        rc = 0;
        goto done;
    }
    for (int32_t t = 0; t < p->nt; t++) {
        const int32_t a = to[p->t[t].v[0]], b = to[p->t[t].v[1]], c = to[p->t[t].v[2]];
        if (a != b && b != c && c != a) p->t[kept++] = (fl_tri){{a, b, c}};
    }
    w->collapsed = p->nt - kept;
    p->nt = kept;
    renumber_by_use(p, to, scratch);
    rc = 0;
done:
    free(to);
    free(scratch);
    return rc;
}
