/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "stat/extreme.h"
#include "stat/moving_mean.h"
#include "stat/resample.h"
#include "stat/signal_view.h"

const char *fl_filter_name(int kind)
{
    static const char *const name[FL_FILTER_KINDS] = {"low", "high", "band", "mean"};
    return name[kind];
}

static int design_filter(fl_butterworth *f, double fs, const fl_signal_view_settings *settings, fl_err *err)
{
    switch (settings->kind) {
    case FL_FILTER_HIGH: return fl_butterworth_high(f, settings->order, settings->filter, fs, err);
    case FL_FILTER_BAND:
        return fl_butterworth_band(f, settings->order, settings->filter, settings->upper, fs, err);
    default: return fl_butterworth_low(f, settings->order, settings->filter, fs, err);
    }
}

static int apply_filter(fl_signal_view *v, const fl_series *s, const double *x,
                        const fl_signal_view_settings *settings, fl_err *err)
{
    const int32_t n = s->n;
    const int mean = settings->kind == FL_FILTER_MEAN,
              even = mean || fl_resample_common_interval(n, s->edge) > 0.0;
    fl_butterworth f;
    if (!mean && design_filter(&f, n / (s->edge[n] - s->edge[0]), settings, err)) return -1;
    v->owned = fl_alloc(3 * (int64_t)n + 1, sizeof *v->owned, err);
    if (!v->owned) return -1;
    double *y = v->owned, *t = y + n, *edge = t + n;
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
    return mean ? fl_moving_mean(n, s->edge, x, settings->filter, y, err)
                : fl_butterworth_zero_phase(&f, n, y, y, err);
}

static int compute_stats(fl_signal_view *v, const fl_signal_view_settings *settings, fl_err *err)
{
    int rc = -1;
    double *w = fl_alloc(v->n, sizeof *w, err);
    if (!w) return -1;
    for (int32_t k = 0; k < v->n; k++) w[k] = v->edge[k + 1] - v->edge[k];
    fl_compute_moments(v->n, v->x, w, &v->stats);
    v->quantile = fl_alloc(settings->quantiles, sizeof *v->quantile, err);
    if (v->quantile)
        rc = fl_compute_quantiles(v->n, v->x, w, settings->quantiles, settings->p, v->quantile, err);
    free(w);
    return rc;
}

/* Sets y, the signal whose maxima are the peaks. */
static int turn_signal(fl_signal_view *v, int side, fl_err *err)
{
    v->y = v->x;
    if (side == FL_PEAK_MAX) return 0;
    v->turned = fl_alloc(v->n, sizeof *v->turned, err);
    if (!v->turned) return -1;
    for (int32_t k = 0; k < v->n; k++) v->turned[k] = fl_peak_turned(side, v->x[k]);
    v->y = v->turned;
    return 0;
}

static int rank_peaks(fl_signal_view *v, const fl_signal_view_settings *settings, fl_err *err)
{
    if (turn_signal(v, settings->side, err) ||
        fl_peaks_rayleigh(v->n, v->y, settings->ratio, fmax(settings->threshold, 0.0), &v->peaks, err))
        return -1;
    const int32_t n = v->peaks.n;
    double *value = fl_alloc(n, sizeof *value, err);
    v->peak_rank = value ? fl_alloc(n, sizeof *v->peak_rank, err) : NULL;
    v->peak_value = v->peak_rank ? fl_alloc(n, sizeof *v->peak_value, err) : NULL;
    int rc = v->peak_value ? 0 : -1;
    for (int32_t k = 0; rc == 0 && k < n; k++) value[k] = v->y[v->peaks.row[k]];
    if (rc == 0) rc = fl_rank_descending(n, value, v->peak_rank, err);
    for (int32_t k = 0; rc == 0 && k < n; k++) v->peak_value[k] = value[v->peak_rank[k]];
    free(value);
    return rc;
}

int fl_signal_view_make(fl_signal_view *v, const fl_series *s, int32_t part, int32_t signal,
                        const fl_signal_view_settings *settings, fl_err *err)
{
    const double *x = s->x[(int64_t)part * s->signals + signal];
    *v = (fl_signal_view){.n = s->n, .t = s->t, .edge = s->edge, .x = x};
    if ((settings->filter > 0.0 && apply_filter(v, s, x, settings, err)) || compute_stats(v, settings, err) ||
        rank_peaks(v, settings, err)) {
        fl_signal_view_free(v);
        return -1;
    }
    return 0;
}

void fl_signal_view_free(fl_signal_view *v)
{
    free(v->owned);
    free(v->turned);
    fl_peaks_free(&v->peaks);
    free(v->peak_rank);
    free(v->peak_value);
    free(v->quantile);
    *v = (fl_signal_view){0};
}
