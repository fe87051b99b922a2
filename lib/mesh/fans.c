/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/mem.h"
#include "mesh/fans.h"

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

/* Does each triangle end in the edge in which one begins, round to the first one?  Going round in as many
 * steps as there are triangles and not less meets every one of them, so that no two begin in the same edge.
 * The search begins where it ended: many files go round, too. */
static int goes_round(const petal *f, int n)
{
    int at = 0;
    for (int step = 1; step <= n; step++) {
        int next = at, left = n;
        do next = next + 1 < n ? next + 1 : 0;
        while (f[next].a != f[at].b && --left > 0);
        if (left == 0 || (next == 0) != (step == n)) return 0;
        at = next;
    }
    return n > 0;
}

static int lies_open(const fl_part *p, int32_t v, const int32_t *t, int n, petal *f)
{
    fl_vec3 d = {0};
    double most;
    if (!open_fan(p, v, t, n, f, &most) || !goes_round(f, n)) return 0;
    for (int i = 0; i < n; i++) d = v3_add(d, f[i].up);
    const double blur = BLUR * (fabs(d.x) + fabs(d.y) + fabs(d.z)) * most * most + TINY;
    for (int i = 0; i < n; i++)
        if (!(v3_dot(d, f[i].up) > blur)) return 0;
    /* Next to its first side sector 0 is there; the one that ends in that side is not; no other may be. */
    const fl_vec3 before = v3_cross(d, f[0].x); /* d . (x x x0) = -before . x */
    for (int i = 1; i < n; i++) {
        if (f[i].b == f[0].a) continue;
        if (!(v3_dot(before, f[i].x) > blur || v3_dot(before, f[i].y) < -blur)) return 0;
    }
    return 1;
}

static int is_tame(const fl_part *p, int32_t v, const int32_t *t, int n)
{
    petal few[FEW], *f = few;
    int tame;
    if (n > FL_FANS_MOST) return 0;
    if (n > FEW) f = malloc((size_t)n * sizeof *f);
    if (!f) return 0; /* which is always right, and takes time */
    tame = lies_open(p, v, t, n, f);
    if (f != few) free(f);
    return tame;
}

int fl_fans_tame(const fl_part *p, uint8_t *tame, fl_err *err)
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
#pragma omp parallel for schedule(dynamic, 4096)
    for (int32_t v = 0; v < p->nv; v++) {
        const int64_t n = first[v + 1] - first[v];
        tame[v] = (uint8_t)is_tame(p, v, list + first[v], n > FL_FANS_MOST ? FL_FANS_MOST + 1 : (int)n);
    }
    free(first);
    free(list);
    return 0;
}
