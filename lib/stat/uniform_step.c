/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/uniform_step.h"
#include "stat/resample.h"

/* Times are decimal: the last step may end beyond the record by rounding. */
static const double SLACK = 1e-9; /* of the record */

enum { ROWS_MAX = INT32_MAX / 8 };

static fl_resampling_loss loss_of(int32_t n, const double *edge, const double *x, int32_t m,
                                  const double *even, const double *y)
{
    fl_resampling_loss l = {0};
    int32_t k = 0;
    for (int32_t j = 0; j < m; j++) {
        for (;;) {
            const double part = fmin(edge[k + 1], even[j + 1]) - fmax(edge[k], even[j]),
                         d = fabs(x[k] - y[j]);
            if (part > 0.0) {
                l.rms += part * d * d;
                l.largest = fmax(l.largest, d);
            }
            if (k + 1 == n || edge[k + 1] >= even[j + 1]) break;
            k++;
        }
    }
    l.rms = sqrt(l.rms / (even[m] - even[0]));
    return l;
}

/* The number of rows that the steps cover, and their edges; the last edge is the end of the last step. */
static int32_t covered_rows(const fl_series *s, double end, double *edge)
{
    int32_t n = 0;
    while (n < s->n && s->edge[n] < end) {
        edge[n] = s->edge[n];
        n++;
    }
    edge[n] = end;
    return n;
}

int fl_resample_uniform(fl_series *s, double step, fl_resampling_loss *loss, fl_err *err)
{
    const double first = s->edge[0], span = s->edge[s->n] - first, steps = floor(span / step * (1.0 + SLACK));
    const int64_t pairs = (int64_t)s->parts * s->signals;
    if (!(steps >= 1.0) || steps > ROWS_MAX)
        return fl_fail(err, FL_INPUT, "steps of %g s in a record of %g s, expected 1 to %d steps", step, span,
                       ROWS_MAX);
    const int32_t m = (int32_t)steps;
    double *edge = fl_alloc((int64_t)s->n + 1, sizeof *edge, err);
    double *even = edge ? fl_alloc((int64_t)m + 1, sizeof *even, err) : NULL;
    double *t = even ? fl_alloc(m, sizeof *t, err) : NULL, **x = t ? fl_alloc(pairs, sizeof *x, err) : NULL;
    int rc = x ? 0 : -1;
    const int32_t n = rc ? 0 : covered_rows(s, first + step * m, edge);
    for (int64_t k = 0; k < pairs && rc == 0; k++) {
        if (loss) loss[k] = (fl_resampling_loss){0};
        if (!s->x[k]) continue;
        x[k] = fl_alloc(m, sizeof **x, err);
        rc = x[k] ? 0 : -1;
        if (rc) break;
        fl_resample_means(n, edge, s->x[k], m, even, x[k]);
        if (loss) loss[k] = loss_of(n, edge, s->x[k], m, even, x[k]);
    }
    free(edge);
    if (rc) {
        for (int64_t k = 0; x && k < pairs; k++) free(x[k]);
        free(x);
        free(t);
        free(even);
        return -1;
    }
    const int ends = strcmp(s->kind, "loads") == 0;
    for (int32_t k = 0; k < m; k++) t[k] = ends ? even[k + 1] : even[k] + 0.5 * (even[k + 1] - even[k]);
    for (int64_t k = 0; k < pairs; k++) free(s->x[k]);
    free(s->x);
    free(s->t);
    free(s->edge);
    s->n = m;
    s->x = x;
    s->t = t;
    s->edge = even;
    return 0;
}
