/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "geom/edges.h"

static int compare_ends(const void *x, const void *y)
{
    const fl_half_edge *a = x, *b = y;
    if (a->hi != b->hi) return a->hi < b->hi ? -1 : 1;
    if (a->t != b->t) return a->t < b->t ? -1 : 1;
    return a->k - b->k;
}

/* A vertex has few half-edges unless it is the hub of a fan. */
static void sort_bucket(fl_half_edge *s, int64_t n)
{
    enum { INSERTION_MAX = 24 };
    if (n > INSERTION_MAX) {
        qsort(s, (size_t)n, sizeof *s, compare_ends);
        return;
    }
    for (int64_t i = 1; i < n; i++) {
        const fl_half_edge x = s[i];
        int64_t k = i;
        for (; k > 0 && compare_ends(&s[k - 1], &x) > 0; k--) s[k] = s[k - 1];
        s[k] = x;
    }
}

static int32_t lower_end(const fl_tri *t, int k)
{
    const int32_t a = t->v[k], b = t->v[(k + 1) % 3];
    return a < b ? a : b;
}

/* Distributes the half-edges to their lower ends and sorts each bucket. */
static void fill_buckets(const fl_part *p, int64_t *first, fl_half_edge *s)
{
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3 && !fl_tri_repeats_vertex(&p->t[t]); k++) first[lower_end(&p->t[t], k) + 1]++;
    for (int32_t v = 0; v < p->nv; v++) first[v + 1] += first[v];
    for (int32_t t = 0; t < p->nt; t++)
        for (int k = 0; k < 3 && !fl_tri_repeats_vertex(&p->t[t]); k++) {
            const int32_t a = p->t[t].v[k], b = p->t[t].v[(k + 1) % 3];
            s[first[lower_end(&p->t[t], k)]++] = (fl_half_edge){a < b ? b : a, t, (int8_t)k, a < b};
        }
    for (int32_t v = p->nv; v > 0; v--) first[v] = first[v - 1]; /* restore the starts */
    first[0] = 0;
    for (int32_t v = 0; v < p->nv; v++) sort_bucket(s + first[v], first[v + 1] - first[v]);
}

int fl_edges_make(fl_edges *e, const fl_part *p, fl_err *err)
{
    *e = (fl_edges){0};
    e->first = fl_alloc((int64_t)p->nv + 1, sizeof *e->first, err);
    e->side = e->first ? fl_alloc(3 * (int64_t)p->nt, sizeof *e->side, err) : NULL;
    if (!e->side) {
        fl_edges_free(e);
        return -1;
    }
    fill_buckets(p, e->first, e->side);
    return 0;
}

void fl_edges_free(fl_edges *e)
{
    free(e->first);
    free(e->side);
    *e = (fl_edges){0};
}
