/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "base/number_text.h"
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "table_stats.h"

int stats_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
               int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    const fl_descriptive_stats *d = &v->stats;
    const int32_t n = v->peaks.n;
    (void)err;
    write_labels(f, r, part, signal, w);
    write_cell(f, v->edge[0]);
    write_cell(f, v->edge[v->n]);
    fprintf(f, "\t%d", v->n);
    write_cell(f, d->mean);
    write_cell(f, d->std);
    write_cell(f, d->skew);
    write_cell(f, d->kurtosis);
    write_cell(f, d->min);
    write_cell(f, d->max);
    write_cell(f, v->t[d->at_max]);
    for (int32_t k = 0; k < o->quantiles; k++) write_cell(f, v->quantile[k]);
    fprintf(f, "\t%d", n);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 1.0) : NAN);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 1.0 / 3.0) : NAN);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 0.1) : NAN);
    write_cell(f, v->t[d->at_min]);
    write_cell(f, fmax(fabs(d->min), fabs(d->max)));
    putc('\n', f);
    return 0;
}

int peaks_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
               int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    (void)o;
    (void)err;
    for (int32_t k = 0; k < v->peaks.n; k++) {
        write_labels(f, r, part, signal, w);
        write_cell(f, v->t[v->peaks.row[k]]);
        write_cell(f, v->y[v->peaks.row[k]]);
        putc('\n', f);
    }
    return 0;
}

int exceedance_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                    int32_t signal, int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    (void)o;
    (void)err;
    for (int32_t k = 0; k < v->peaks.n; k++) {
        write_labels(f, r, part, signal, w);
        fprintf(f, "\t%d", k + 1);
        write_cell(f, v->peak_value[k]);
        write_cell(f, fl_plotting_position(k + 1, v->peaks.n));
        putc('\n', f);
    }
    return 0;
}

/* Raw and filtered views share their classes, so that rows can be compared. */
int histogram_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                   int32_t signal, fl_err *err)
{
    double lo = INFINITY, hi = -INFINITY;
    int rc = 0;
    for (int w = 0; w < r->view_count; w++) {
        const fl_signal_view *v = find_view(r, part, signal, w);
        lo = fmin(lo, v->stats.min);
        hi = fmax(hi, v->stats.max);
        if (v->y != v->x && v->peaks.n) hi = fmax(hi, v->peak_value[0]);
    }
    for (int w = 0; w < r->view_count && rc == 0; w++) {
        const fl_signal_view *v = find_view(r, part, signal, w);
        fl_histogram time = {0}, peaks = {0};
        rc = fl_histogram_make(&time, o->bins, lo, hi, err) ? -1
                                                            : fl_histogram_make(&peaks, o->bins, lo, hi, err);
        for (int32_t k = 0; rc == 0 && k < v->n; k++)
            fl_histogram_add(&time, v->x[k], v->edge[k + 1] - v->edge[k]);
        for (int32_t k = 0; rc == 0 && k < v->peaks.n; k++) fl_histogram_add(&peaks, v->peak_value[k], 1.0);
        for (int32_t k = 0; rc == 0 && k < o->bins; k++) {
            write_labels(f, r, part, signal, w);
            write_cell(f, time.range[k]);
            write_cell(f, time.range[k + 1]);
            write_cell(f, time.bin[k]);
            write_cell(f, time.bin[k] / v->stats.time);
            write_cell(f, peaks.bin[k]);
            putc('\n', f);
        }
        fl_histogram_free(&time);
        fl_histogram_free(&peaks);
    }
    return rc;
}

void stats_more_columns(FILE *f, const struct options *o)
{
    char buf[FL_NUMBER_LEN];
    for (int32_t k = 0; k < o->quantiles; k++) fprintf(f, "\tq%s", fl_number_text(o->quantile[k], buf));
    fputs("\tpeaks\tpeak_mean\tpeak_third\tpeak_tenth\tt_min[s]\tlargest", f);
}
