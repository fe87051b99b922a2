/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "mesh/vertex_fans.h"

/* Relative rounding error of d . (x x y).  With x and y differences of coordinates of size up to m, and s the
 * sum of the absolute values of d, the two differences, six products and five sums lose less than 14 s m^2
 * 2^-53.  This is more than twice that. */
static const double ROUNDING = 0x1p-48;
/* Below this, products may have lost digits to underflow. */
static const double UNDERFLOW_LIMIT = 1e-280;

/* Triangles of most vertices; their sectors are kept on the stack. */
enum { SMALL_FAN = 64 };
typedef struct {
    int32_t a, b;
    fl_vec3 x, y; /* from the vertex to a and b */
    fl_vec3 up;   /* x cross y */
} sector;

static double larger(double a, double b) { return a > b ? a : b; }
static double size_of(fl_vec3 x) { return larger(fabs(x.x), larger(fabs(x.y), fabs(x.z))); }

/* Fill the sectors of vertex v.  Returns 0 if a triangle has the vertex twice. */
static int fill_sectors(const fl_part *p, int32_t v, const int32_t *t, int n, sector *f, double *most)
{
    const fl_vec3 o = p->v[v];
    *most = 0.0;
    for (int i = 0; i < n; i++) {
        const int32_t *c = p->t[t[i]].v;
        const int k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        sector *q = &f[i];
        q->a = c[(k + 1) % 3];
        q->b = c[(k + 2) % 3];
        if (q->a == v || q->b == v) return 0;
        q->x = v3_sub(p->v[q->a], o);
        q->y = v3_sub(p->v[q->b], o);
        q->up = v3_cross(q->x, q->y);
        *most = larger(*most, larger(size_of(q->x), size_of(q->y)));
    }
    return 1;
}

/* A sector by its first vertex, for searching in large fans. */
typedef struct {
    int32_t a;
    int at;
} sector_start;

static int by_vertex(const void *pa, const void *pb)
{
    const sector_start *x = pa, *y = pb;
    return x->a != y->a ? (x->a < y->a ? -1 : 1) : x->at - y->at;
}

/* The sector that begins where sector `at` ends, -1 for none; always the same one.  In small fans the search
 * starts behind `at`, since many files list triangles in cyclic order. */
static int next_sector(const sector *f, int n, const sector_start *sorted, int at)
{
    const int32_t v = f[at].b;
    int lo = 0, hi = n, left = n;
    if (sorted) {
        while (lo < hi) {
            const int mid = lo + (hi - lo) / 2;
            if (sorted[mid].a < v) lo = mid + 1;
            else hi = mid;
        }
        return lo < n && sorted[lo].a == v ? sorted[lo].at : -1;
    }
    do at = at + 1 < n ? at + 1 : 0;
    while (f[at].a != v && --left > 0);
    return left > 0 ? at : -1;
}

/* A sector that begins where none ends, -1 for none; met[n] is scratch. */
static int chain_start(const sector *f, int n, const sector_start *sorted, uint8_t *met)
{
    for (int i = 0; i < n; i++) met[i] = 0;
    for (int i = 0; i < n; i++) {
        const int next = next_sector(f, n, sorted, i);
        if (next >= 0) met[next] = 1;
    }
    for (int i = 0; i < n; i++)
        if (!met[i]) return i;
    return -1;
}

/* True if the sectors form one ring or one chain.  A walk of exactly n steps that returns to its start, or
 * ends, visits every sector: one that visited a sector twice would never end.  Returns the first sector of
 * the walk, -1 if they form neither. */
static int order_fan(const sector *f, int n, const sector_start *sorted, uint8_t *met)
{
    int first = 0, at = 0, steps = 1;
    for (; steps <= n; steps++) {
        at = next_sector(f, n, sorted, at);
        if (at <= 0) break;
    }
    if (at == 0) return steps == n ? 0 : -1;
    if (at > 0) return -1;
    first = at = chain_start(f, n, sorted, met);
    for (steps = 0; at >= 0 && steps <= n; steps++) at = next_sector(f, n, sorted, at);
    return steps == n ? first : -1;
}

static int is_covered_once(const sector *f, int n, int first, double most)
{
    fl_vec3 d = {0};
    for (int i = 0; i < n; i++) d = v3_add(d, f[i].up);
    const double error = ROUNDING * (fabs(d.x) + fabs(d.y) + fabs(d.z)) * most * most + UNDERFLOW_LIMIT;
    for (int i = 0; i < n; i++)
        if (!(v3_dot(d, f[i].up) > error)) return 0;
    /* Next to its first side, the first sector covers the direction; a sector that ends in that side does
     * not; no other sector may. */
    const fl_vec3 before = v3_cross(d, f[first].x); /* d . (x x x0) = -before . x */
    for (int i = 0; i < n; i++) {
        if (i == first || f[i].b == f[first].a) continue;
        if (!(v3_dot(before, f[i].x) > error || v3_dot(before, f[i].y) < -error)) return 0;
    }
    return 1;
}

/* The arrays of a large fan. */
typedef struct {
    sector *f;
    sector_start *sorted;
    uint8_t *met;
} fan_arrays;

static int is_simple(const fl_part *p, int32_t v, const int32_t *t, int n)
{
    sector small[SMALL_FAN];
    uint8_t met[SMALL_FAN];
    fan_arrays g = {small, NULL, met};
    double most;
    int simple = 0, first;
    if (n < 1 || n > FL_VERTEX_FAN_MAX) return 0;
    if (n > SMALL_FAN) { /* without memory the answer is 0, which is always valid and only slower */
        g.f = malloc((size_t)n * sizeof *g.f);
        g.sorted = malloc((size_t)n * sizeof *g.sorted);
        g.met = malloc((size_t)n);
        if (!g.f || !g.sorted || !g.met) goto done;
    }
    if (!fill_sectors(p, v, t, n, g.f, &most)) goto done;
    for (int i = 0; i < n && g.sorted; i++) g.sorted[i] = (sector_start){g.f[i].a, i};
    if (g.sorted) qsort(g.sorted, (size_t)n, sizeof *g.sorted, by_vertex);
    first = order_fan(g.f, n, g.sorted, g.met);
    simple = first >= 0 && is_covered_once(g.f, n, first, most);
done:
    if (n > SMALL_FAN) {
        free(g.f);
        free(g.sorted);
        free(g.met);
    }
    return simple;
}

int fl_vertex_fans_simple(const fl_part *p, uint8_t *simple, fl_err *err)
{
    int64_t *first = fl_alloc((int64_t)p->nv + 1, sizeof *first, err);
    int32_t *list = first ? fl_alloc(3 * (int64_t)p->nt, sizeof *list, err) : NULL;
    if (!list) {
        free(first);
        return -1;
    }
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3; k++) first[p->t[t].v[k]]++;
    for (int32_t v = 1; v <= p->nv; v++) first[v] += first[v - 1];
    for (int32_t t = p->nt; t-- > 0;)
        for (int k = 0; k < 3; k++) list[--first[p->t[t].v[k]]] = t;
#pragma omp parallel for schedule(dynamic, 4096) if (p->nv > 4096)
    for (int32_t v = 0; v < p->nv; v++) {
        const int64_t n = first[v + 1] - first[v];
        simple[v] =
            (uint8_t)is_simple(p, v, list + first[v], n > FL_VERTEX_FAN_MAX ? FL_VERTEX_FAN_MAX + 1 : (int)n);
    }
    free(first);
    free(list);
    return 0;
}
