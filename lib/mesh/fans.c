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
typedef struct {
    int n;
    int32_t a[FL_FANS_MOST], b[FL_FANS_MOST];
    fl_vec3 x[FL_FANS_MOST], y[FL_FANS_MOST]; /* from the vertex to them */
    fl_vec3 up[FL_FANS_MOST];                 /* x cross y */
} fan;

static double larger(double a, double b) { return a > b ? a : b; }
static double size_of(fl_vec3 x) { return larger(fabs(x.x), larger(fabs(x.y), fabs(x.z))); }

/* 0 when a triangle has the vertex twice. */
static int open_fan(const fl_part *p, int32_t v, const int32_t *t, int n, fan *f, double *most)
{
    const fl_vec3 o = p->v[v];
    *most = 0.0;
    f->n = n;
    for (int i = 0; i < n; i++) {
        const int32_t *c = p->t[t[i]].v;
        const int k = c[0] == v ? 0 : c[1] == v ? 1 : 2;
        f->a[i] = c[(k + 1) % 3];
        f->b[i] = c[(k + 2) % 3];
        if (f->a[i] == v || f->b[i] == v) return 0;
        f->x[i] = v3_sub(p->v[f->a[i]], o);
        f->y[i] = v3_sub(p->v[f->b[i]], o);
        *most = larger(*most, larger(size_of(f->x[i]), size_of(f->y[i])));
    }
    return 1;
}

/* Does each triangle end in the edge in which one begins, round to the first one?  Going round in as many
 * steps as there are triangles and not less meets every one of them, so that no two begin in the same edge.
 */
static int goes_round(const fan *f)
{
    int at = 0;
    for (int step = 1; step <= f->n; step++) {
        int next = 0;
        while (next < f->n && f->a[next] != f->b[at]) next++;
        if (next == f->n || (next == 0) != (step == f->n)) return 0;
        at = next;
    }
    return f->n > 0;
}

static int is_tame(const fl_part *p, int32_t v, const int32_t *t, int n)
{
    fan f;
    fl_vec3 d = {0};
    double most;
    if (n > FL_FANS_MOST || !open_fan(p, v, t, n, &f, &most) || !goes_round(&f)) return 0;
    for (int i = 0; i < n; i++) {
        f.up[i] = v3_cross(f.x[i], f.y[i]);
        d = v3_add(d, f.up[i]);
    }
    const double blur = BLUR * (fabs(d.x) + fabs(d.y) + fabs(d.z)) * most * most + TINY;
    for (int i = 0; i < n; i++)
        if (!(v3_dot(d, f.up[i]) > blur)) return 0;
    /* Next to its first side sector 0 is there; the one that ends in that side is not; no other may be. */
    const fl_vec3 before = v3_cross(d, f.x[0]); /* d . (x x x0) = -before . x */
    for (int i = 1; i < n; i++) {
        if (f.b[i] == f.a[0]) continue;
        if (!(v3_dot(before, f.x[i]) > blur || v3_dot(before, f.y[i]) < -blur)) return 0;
    }
    return 1;
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
#pragma omp parallel for schedule(static)
    for (int32_t v = 0; v < p->nv; v++) {
        const int64_t n = first[v + 1] - first[v];
        tame[v] = (uint8_t)is_tame(p, v, list + first[v], n > FL_FANS_MOST ? FL_FANS_MOST + 1 : (int)n);
    }
    free(first);
    free(list);
    return 0;
}
