/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include "base/array.h"
#include "stat/extreme.h"

typedef struct {
    double x;
    int32_t at;
} ranked_value;

static int compare_descending(const void *a, const void *b)
{
    const ranked_value *p = a, *q = b;
    if (p->x != q->x) return p->x > q->x ? -1 : 1;
    return (p->at > q->at) - (p->at < q->at);
}

int fl_rank_descending(int32_t n, const double *x, int32_t *rank, fl_err *err)
{
    ranked_value *e = fl_alloc(n, sizeof *e, err);
    if (!e) return -1;
    for (int32_t k = 0; k < n; k++) e[k] = (ranked_value){x[k], k};
    qsort(e, (size_t)n, sizeof *e, compare_descending);
    for (int32_t k = 0; k < n; k++) rank[k] = e[k].at;
    free(e);
    return 0;
}

double fl_plotting_position(int32_t i, int32_t n) { return i / (n + 1.0); }
