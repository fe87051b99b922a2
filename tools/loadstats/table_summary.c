/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/mean_interval.h"
#include "stat/rainflow.h"
#include "table_kind.h"
#include "table_rainflow.h"
#include "table_summary.h"

int ensemble_add(ensemble *e, const fl_summary *all, const fl_summary *one, const char *name, fl_err *err)
{
    if (e->runs == 0) e->signals = one->n;
    if (one->n != e->signals || all->n != e->signals)
        return fl_fail(err, FL_INPUT, "%s: its parts and signals differ from those of the runs before", name);
    if (fl_grow(&e->x, &e->cap, ENSEMBLE_VALUES * ((int64_t)e->runs + 1) * e->signals, sizeof *e->x, err))
        return -1;
    double *x = e->x + ENSEMBLE_VALUES * (int64_t)e->runs * e->signals;
    for (int32_t k = 0; k < e->signals; k++) {
        const fl_summary_signal *s = &one->entry[k];
        if (fl_multiset_size(&s->run[FL_RUN_MEAN]) != 1)
            return fl_fail(err, FL_INPUT, "%s: a summary of several runs, expected one run per file", name);
        *x++ = s->run[FL_RUN_MEAN].v[0].x;
        *x++ = s->run[FL_RUN_MAX].v[0].x;
        *x++ = s->run[FL_RUN_MIN].v[0].x;
    }
    e->runs++;
    return 0;
}

static void write_run_labels(FILE *f, const fl_summary_signal *s)
{
    fprintf(f, "%s\t%s\t%s", s->part, s->signal, s->unit[0] ? s->unit : "-");
}

/* Largest value of the signal whose maxima are the peaks. */
static double largest_turned(const fl_summary_signal *s, int side)
{
    const double high = fl_peak_turned(side, s->max), low = fl_peak_turned(side, s->min);
    return high > low ? high : low;
}

/* One row.  What is open at the end of the data so far, such as a last peak, is not included. */
int stats_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err)
{
    const fl_summary_signal *s = &runs->all.entry[entry];
    double moment[4], lo = NAN, hi = NAN;
    fl_log_bin *level = NULL, *peak = NULL;
    if (fl_log_histogram_sort(&s->level, &level, err) || fl_log_histogram_sort(&s->peak, &peak, err)) {
        free(level);
        return -1;
    }
    if (s->peak.n) {
        lo = fl_log_bin_lower(peak[0].key);
        hi = fmin(fl_log_bin_upper(peak[s->peak.n - 1].key), largest_turned(s, runs->all.settings.side));
    }
    fl_summary_moments(s, moment);
    write_run_labels(f, s);
    fputs("\traw", f);
    write_cell(f, s->from);
    write_cell(f, s->to);
    fprintf(f, "\t%lld", (long long)s->rows);
    for (int k = 0; k < 4; k++) write_cell(f, moment[k]);
    write_cell(f, s->min);
    write_cell(f, s->max);
    write_cell(f, s->t_max);
    for (int32_t k = 0; k < o->quantiles; k++)
        write_cell(f, fl_log_histogram_quantile(s->level.n, level, o->quantile[k], s->min, s->max));
    fprintf(f, "\t%lld", (long long)s->peaks);
    write_cell(f, s->peaks ? fl_exact_value(&s->peak_sum) / (double)s->peaks : NAN);
    write_cell(f, s->peaks ? fl_log_histogram_mean_highest(s->peak.n, peak, 1.0 / 3.0, lo, hi) : NAN);
    write_cell(f, s->peaks ? fl_log_histogram_mean_highest(s->peak.n, peak, 0.1, lo, hi) : NAN);
    write_cell(f, s->t_min);
    write_cell(f, fmax(fabs(s->min), fabs(s->max)));
    putc('\n', f);
    free(level);
    free(peak);
    return 0;
}

static void write_interval(FILE *f, const fl_mean_interval *e)
{
    write_cell(f, e->mean);
    write_cell(f, e->low);
    write_cell(f, e->high);
    write_cell(f, e->std);
}

int ensemble_rows(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err)
{
    const ensemble *e = &runs->e;
    double *mean = fl_alloc(2 * (int64_t)e->runs, sizeof *mean, err), *max = mean + e->runs;
    double largest = -INFINITY, least = INFINITY;
    (void)o;
    if (!mean) return -1;
    for (int32_t n = 0; n < e->runs; n++) {
        const double *x = e->x + ENSEMBLE_VALUES * ((int64_t)n * e->signals + entry);
        mean[n] = x[0];
        max[n] = x[1];
        largest = fmax(largest, max[n]);
        least = fmin(least, x[2]);
        const int sign = least >= 0.0 ? 1 : largest <= 0.0 ? -1 : 0; /* of the signal in all runs */
        const fl_mean_interval a = fl_mean_interval_of_sign(fl_mean_interval_of(n + 1, mean), sign),
                               b = fl_mean_interval_of_sign(fl_mean_interval_of(n + 1, max), sign);
        write_run_labels(f, &runs->all.entry[entry]);
        fprintf(f, "\t%d", n + 1);
        write_interval(f, &a);
        write_interval(f, &b);
        write_cell(f, largest);
        write_cell(f, least);
        write_cell(f, fmax(fabs(least), fabs(largest)));
        write_cell(f, n ? fl_runs_for(a.std, a.mean, 0.05) : NAN);
        write_cell(f, n ? fl_runs_for(b.std, b.mean, 0.05) : NAN);
        putc('\n', f);
    }
    free(mean);
    return 0;
}

/* Duration and peaks of the logarithmic classes of the values. */
int histogram_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o,
                      fl_err *err)
{
    const fl_summary_signal *s = &runs->all.entry[entry];
    (void)o;
    fl_log_bin *level = NULL, *peak = NULL;
    if (fl_log_histogram_sort(&s->level, &level, err) || fl_log_histogram_sort(&s->peak, &peak, err)) {
        free(level);
        return -1;
    }
    const double total = fl_exact_value(&s->sum[0]);
    /* A peak is a value, so its class is among the classes of values, unless the signal is turned. */
    for (int32_t k = 0, j = 0; k < s->level.n || j < s->peak.n;) {
        const int valued = k < s->level.n && !(j < s->peak.n && peak[j].key < level[k].key),
                  peaked = j < s->peak.n && !(k < s->level.n && level[k].key < peak[j].key);
        const int32_t key = valued ? level[k].key : peak[j].key;
        const double time = valued ? fl_fixed_time_seconds(level[k++].time) : 0.0;
        const int64_t peaks = peaked ? peak[j++].n : 0;
        write_run_labels(f, s);
        fputs("\traw", f);
        write_cell(f, fl_log_bin_lower(key));
        write_cell(f, fl_log_bin_upper(key));
        write_cell(f, time);
        write_cell(f, time / total);
        fprintf(f, "\t%lld\n", (long long)peaks);
    }
    free(level);
    free(peak);
    return 0;
}

/* Distributions of the largest values of the blocks, or of the runs, put together as one record. */
int fits_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err)
{
    const fl_summary *all = &runs->all;
    const fl_summary_signal *s = &all->entry[entry];
    const int of_runs = o->sample == SAMPLE_RUNS || !(all->settings.block > 0.0);
    const int turned = of_runs && all->settings.side == FL_PEAK_MIN;
    const fl_multiset *values = of_runs ? &s->run[turned ? FL_RUN_MIN : FL_RUN_MAX] : &s->block;
    const int64_t n = fl_multiset_size(values);
    struct options own = *o;
    own.sample = of_runs ? SAMPLE_RUNS : SAMPLE_BLOCKS;
    own.block = of_runs ? fl_exact_value(&s->sum[0]) / (double)n : all->settings.block;
    if (n < 1 || n > INT32_MAX / 4)
        return fl_fail(err, FL_INPUT, "%s of %s has %lld maxima of blocks, expected at least 1", s->signal,
                       s->part, (long long)n);
    double *x = fl_alloc(2 * n + 1, sizeof *x, err), *edge = x + n;
    if (!x) return -1;
    for (int32_t k = 0, i = 0; k < values->n; k++)
        for (int64_t j = 0; j < values->v[k].count; j++) x[i++] = turned ? -values->v[k].x : values->v[k].x;
    for (int64_t k = 0; k <= n; k++) edge[k] = own.block * (double)k;
    char *part = s->part, *signal = s->signal, *unit = s->unit;
    const fl_series series = {.n = (int32_t)n,
                              .t = edge,
                              .edge = edge,
                              .parts = 1,
                              .signals = 1,
                              .part = &part,
                              .signal = &signal,
                              .unit = &unit,
                              .x = &x};
    const fl_signal_view view = {.n = (int32_t)n, .t = edge, .edge = edge, .x = x, .y = x};
    const struct record_views r = {.series = &series, .views = &view, .view_count = 1};
    const int rc = o->table->view_rows(f, &r, &own, 0, 0, 0, err);
    free(x);
    return rc;
}

/* Load cycles by classes of their range. */
int cycles_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err)
{
    const fl_summary *all = &runs->all;
    const fl_summary_signal *s = &all->entry[entry];
    (void)o;
    fl_log_bin *sorted;
    if (fl_log_histogram_sort(&s->cycle, &sorted, err)) return -1;
    for (int32_t k = 0; k < s->cycle.n; k++) {
        write_run_labels(f, s);
        rainflow_write_rule(f, all->settings.rule, all->settings.residue);
        write_cell(f, fl_log_bin_lower(sorted[k].key));
        write_cell(f, fl_log_bin_upper(sorted[k].key));
        write_cell(f, 0.5 * (double)sorted[k].n);
        putc('\n', f);
    }
    free(sorted);
    return 0;
}

/* Damage of the cycles of all runs; the range of a cycle is the middle of its class. */
int damage_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err)
{
    const fl_summary *all = &runs->all;
    const fl_summary_signal *s = &all->entry[entry];
    const int32_t n = s->cycle.n;
    fl_log_bin *sorted;
    if (fl_log_histogram_sort(&s->cycle, &sorted, err)) return -1;
    fl_cycle *cycle = fl_alloc(n, sizeof *cycle, err);
    for (int32_t k = 0; cycle && k < n; k++) {
        const double lo = fl_log_bin_lower(sorted[k].key), hi = fl_log_bin_upper(sorted[k].key);
        cycle[k] = (fl_cycle){.range = lo + 0.5 * (hi - lo), .count = 0.5 * (double)sorted[k].n};
    }
    const damage_case load = {.part = s->part,
                              .signal = s->signal,
                              .unit = s->unit,
                              .view = view_name(0),
                              .rule = all->settings.rule,
                              .residue = all->settings.residue,
                              .n = n,
                              .cycle = cycle,
                              .span = fl_exact_value(&s->sum[0])};
    if (cycle) damage_write(f, &load, o);
    free(sorted);
    free(cycle);
    return cycle ? 0 : -1;
}
