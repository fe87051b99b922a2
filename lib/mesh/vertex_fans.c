/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "mesh/vertex_fans.h"

/* Of d . (x x y), x and y differences of coordinates of up to m in size and s the sum of the sizes of d: the
 * two differences, six products and five sums lose less than 14 s m^2 units of 2^-53; twice that, and more.
 */
static const double BLUR = 0x1p-48;
/* Below this, products may have lost digits for want of smaller numbers. */
static const double TINY = 1e-280;

/* The triangles at a vertex, each with the two vertices that follow. */
enum { FEW = 64 }; /* of most vertices */
typedef struct {
    int32_t a, b;
    fl_vec3 x, y; /* from the vertex to them */
    fl_vec3 up;   /* x cross y */
} petal;

static double larger(double a, double b) { return a > b ? a : b; }
static double size_of(fl_vec3 x) { return larger(fabs(x.x), larger(fabs(x.y), fabs(x.z))); }

/* 0 when a triangle has the vertex twice. */
static int open_fan(const fl_part *p, int32_t v, const int32_t *t, int n, petal *f, double *most)
{
    const fl_vec3 o = p->v[v];
    *most = 0.0;
    for (int i = 0; i < n; i++) {
        const int32_t *c = p->t[t[i]].v;
        const int k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        petal *q = &f[i];
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

/* The petals by the vertex in which they begin, where they are many. */
typedef struct {
    int32_t a;
    int at;
} beginning;

static int by_vertex(const void *pa, const void *pb)
{
    const beginning *x = pa, *y = pb;
    return x->a != y->a ? (x->a < y->a ? -1 : 1) : x->at - y->at;
}

/* A petal that begins where this one ends, -1 for none; the same one whenever it is asked for.  Of few the
 * search begins behind this one: many files go round, too. */
static int next_of(const petal *f, int n, const beginning *sorted, int at)
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

/* A petal that begins where none ends, -1 for none; met[n] is scratch. */
static int start_of(const petal *f, int n, const beginning *sorted, uint8_t *met)
{
    for (int i = 0; i < n; i++) met[i] = 0;
    for (int i = 0; i < n; i++) {
        const int next = next_of(f, n, sorted, i);
        if (next >= 0) met[next] = 1;
    }
    for (int i = 0; i < n; i++)
        if (!met[i]) return i;
    return -1;
}

/* Does each triangle end in the edge in which one begins, round to the first one, or on to an end?  Going
 * round in as many steps as there are triangles and not less meets every one of them, and so does a walk that
 * ends after that many: one that met a triangle twice would never end.  Returns the first one, -1 for no. */
static int goes_round(const petal *f, int n, const beginning *sorted, uint8_t *met)
{
    int first = 0, at = 0, steps = 1;
    for (; steps <= n; steps++) {
        at = next_of(f, n, sorted, at);
        if (at <= 0) break;
    }
    if (at == 0) return steps == n ? 0 : -1;
    if (at > 0) return -1;
    first = at = start_of(f, n, sorted, met);
    for (steps = 0; at >= 0 && steps <= n; steps++) at = next_of(f, n, sorted, at);
    return steps == n ? first : -1;
}

static int lies_open(const petal *f, int n, int first, double most)
{
    fl_vec3 d = {0};
    for (int i = 0; i < n; i++) d = v3_add(d, f[i].up);
    const double blur = BLUR * (fabs(d.x) + fabs(d.y) + fabs(d.z)) * most * most + TINY;
    for (int i = 0; i < n; i++)
        if (!(v3_dot(d, f[i].up) > blur)) return 0;
    /* Next to its first side the first sector is there; one that ends in that side is not; no other may be.
     */
    const fl_vec3 before = v3_cross(d, f[first].x); /* d . (x x x0) = -before . x */
    for (int i = 0; i < n; i++) {
        if (i == first || f[i].b == f[first].a) continue;
        if (!(v3_dot(before, f[i].x) > blur || v3_dot(before, f[i].y) < -blur)) return 0;
    }
    return 1;
}

/* A flower of many. */
typedef struct {
    petal *f;
    beginning *sorted;
    uint8_t *met;
} garden;

static int is_tame(const fl_part *p, int32_t v, const int32_t *t, int n)
{
    petal few[FEW];
    uint8_t met[FEW];
    garden g = {few, NULL, met};
    double most;
    int tame = 0, first;
    if (n < 1 || n > FL_VERTEX_FAN_MAX) return 0;
    if (n > FEW) { /* without memory the answer is no, which is always right, and takes time */
        g.f = malloc((size_t)n * sizeof *g.f);
        g.sorted = malloc((size_t)n * sizeof *g.sorted);
        g.met = malloc((size_t)n);
        if (!g.f || !g.sorted || !g.met) goto done;
    }
    if (!open_fan(p, v, t, n, g.f, &most)) goto done;
    for (int i = 0; i < n && g.sorted; i++) g.sorted[i] = (beginning){g.f[i].a, i};
    if (g.sorted) qsort(g.sorted, (size_t)n, sizeof *g.sorted, by_vertex);
    first = goes_round(g.f, n, g.sorted, g.met);
    tame = first >= 0 && lies_open(g.f, n, first, most);
done:
    if (n > FEW) {
        free(g.f);
        free(g.sorted);
        free(g.met);
    }
    return tame;
}

int fl_vertex_fans_simple(const fl_part *p, uint8_t *tame, fl_err *err)
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
        tame[v] =
            (uint8_t)is_tame(p, v, list + first[v], n > FL_VERTEX_FAN_MAX ? FL_VERTEX_FAN_MAX + 1 : (int)n);
    }
    free(first);
    free(list);
    return 0;
}
