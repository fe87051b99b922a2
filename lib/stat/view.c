/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include "base/mem.h"
#include "stat/extreme.h"
#include "stat/movemean.h"
#include "stat/resample.h"
#include "stat/view.h"

const char *fl_pass_name(int pass)
{
    static const char *const name[FL_PASSES] = {"low", "high", "band", "mean"};
    return name[pass];
}

static int design(fl_butter *f, double fs, const fl_view_ask *ask, fl_err *err)
{
    switch (ask->pass) {
    case FL_PASS_HIGH: return fl_butter_high(f, ask->order, ask->filter, fs, err);
    case FL_PASS_BAND: return fl_butter_band(f, ask->order, ask->filter, ask->upper, fs, err);
    default: return fl_butter_low(f, ask->order, ask->filter, fs, err);
    }
}

static int filter(fl_view *v, const fl_series *s, const double *x, const fl_view_ask *ask, fl_err *err)
{
    const int32_t n = s->n;
    const int mean = ask->pass == FL_PASS_MEAN, even = mean || fl_resample_step(n, s->edge) > 0.0;
    fl_butter f;
    if (!mean && design(&f, n / (s->edge[n] - s->edge[0]), ask, err)) return -1;
    v->own = fl_alloc(3 * (int64_t)n + 1, sizeof *v->own, err);
    if (!v->own) return -1;
    double *y = v->own, *t = y + n, *edge = t + n;
    if (even) {
        memcpy(y, x, (size_t)n * sizeof *y);
        memcpy(t, s->t, (size_t)n * sizeof *t);
        memcpy(edge, s->edge, ((size_t)n + 1) * sizeof *edge);
    } else {
        const int ends = strcmp(s->kind, "loads") == 0;
        fl_resample_means(n, s->edge, x, n, edge, y);
        for (int32_t k = 0; k < n; k++) t[k] = ends ? edge[k + 1] : edge[k] + 0.5 * (edge[k + 1] - edge[k]);
    }
    v->x = y;
    v->t = t;
    v->edge = edge;
    return mean ? fl_movemean(n, s->edge, x, ask->filter, y, err) : fl_butter_zero_phase(&f, n, y, y, err);
}

static int describe(fl_view *v, const fl_view_ask *ask, fl_err *err)
{
    int rc = -1;
    double *w = fl_alloc(v->n, sizeof *w, err);
    if (!w) return -1;
    for (int32_t k = 0; k < v->n; k++) w[k] = v->edge[k + 1] - v->edge[k];
    fl_describe_moments(v->n, v->x, w, &v->d);
    v->q = fl_alloc(ask->quantiles, sizeof *v->q, err);
    if (v->q) rc = fl_describe_quantiles(v->n, v->x, w, ask->quantiles, ask->p, v->q, err);
    free(w);
    return rc;
}

static int rank(fl_view *v, const fl_view_ask *ask, fl_err *err)
{
    if (fl_peaks_rayleigh(v->n, v->x, ask->ratio, ask->threshold, &v->peaks, err)) return -1;
    const int32_t n = v->peaks.n;
    double *value = fl_alloc(n, sizeof *value, err);
    v->rank = value ? fl_alloc(n, sizeof *v->rank, err) : NULL;
    v->value = v->rank ? fl_alloc(n, sizeof *v->value, err) : NULL;
    int rc = v->value ? 0 : -1;
    for (int32_t k = 0; rc == 0 && k < n; k++) value[k] = v->x[v->peaks.at[k]];
    if (rc == 0) rc = fl_extreme_rank(n, value, v->rank, err);
    for (int32_t k = 0; rc == 0 && k < n; k++) v->value[k] = value[v->rank[k]];
    free(value);
    return rc;
}

int fl_view_make(fl_view *v, const fl_series *s, int32_t part, int32_t signal, const fl_view_ask *ask,
                 fl_err *err)
{
    const double *x = s->x[(int64_t)part * s->signals + signal];
    *v = (fl_view){.n = s->n, .t = s->t, .edge = s->edge, .x = x};
    if ((ask->filter > 0.0 && filter(v, s, x, ask, err)) || describe(v, ask, err) || rank(v, ask, err)) {
        fl_view_free(v);
        return -1;
    }
    return 0;
}

void fl_view_free(fl_view *v)
{
    free(v->own);
    fl_peaks_free(&v->peaks);
    free(v->rank);
    free(v->value);
    free(v->q);
    *v = (fl_view){0};
}
