/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/array.h"
#include "stat/sample.h"

/* Tolerance in blocks: a record of whole blocks must not lose its last one to the rounding of its times. */
static const double SLACK = 1e-6;

static int push_row(fl_peaks *p, int32_t at, fl_err *err)
{
    if (fl_grow(&p->row, &p->cap, (int64_t)p->n + 1, sizeof *p->row, err)) return -1;
    p->row[p->n++] = at;
    return 0;
}

int fl_sample_peaks_over_threshold(int32_t n, const double *x, const double *edge, double threshold,
                                   double gap, fl_peaks *p, fl_err *err)
{
    int32_t last = -1; /* the last row above */
    p->n = 0;
    for (int32_t k = 0; k < n; k++) {
        if (!(x[k] > threshold)) continue;
        const int apart = last < 0 || (last + 1 < k && edge[k] - edge[last + 1] >= gap);
        if (apart && push_row(p, k, err)) return -1;
        if (x[k] > x[p->row[p->n - 1]]) p->row[p->n - 1] = k;
        last = k;
    }
    return 0;
}

int fl_sample_block_maxima(int32_t n, const double *x, const double *edge, double length, fl_peaks *p,
                           int32_t *blocks, fl_err *err)
{
    const double whole = floor((edge[n] - edge[0]) / length + SLACK);
    double now = -1.0;
    p->n = 0;
    for (int32_t k = 0; k < n; k++) {
        const double block = floor((0.5 * (edge[k] + edge[k + 1]) - edge[0]) / length);
        if (block >= whole) break;
        if (block > now && push_row(p, k, err)) return -1;
        now = block;
        if (x[k] > x[p->row[p->n - 1]]) p->row[p->n - 1] = k;
    }
    if (blocks) *blocks = whole < INT32_MAX ? (int32_t)whole : INT32_MAX;
    return 0;
}
