/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "base/array.h"
#include "base/stream.h"
#include "stat/mean_interval.h"
#include "stat/rainflow.h"
#include "stat/run_summary.h"
#include "stat/summary_file.h"
#include "history_line.h"
#include "table_rainflow.h"
#include "table_fits.h"
#include "html_report.h"
#include "plot.h"
#include "table_stats.h"
#include "table_summary.h"

enum { PATH_LEN = 4096, PICTURES_MAX = 48 };

int summary_selected(const struct options *o)
{
    return o->table >= TABLE_SUMMARY || o->merge || o->stream || o->follow > 0.0;
}

/* --- tables --------------------------------------------------------------------------------------------- */

static void label(FILE *f, const fl_summary_signal *s)
{
    fprintf(f, "%s\t%s\t%s", s->part, s->signal, s->unit[0] ? s->unit : "-");
}

/* The row of the table stats; what is left open, a last peak for one, is not in it. */
static int stats_row(FILE *f, const fl_summary_signal *s, const struct options *o, fl_err *err)
{
    double moment[4], lo = NAN, hi = NAN;
    fl_log_bin *level = NULL, *peak = NULL;
    if (fl_log_histogram_sort(&s->level, &level, err) || fl_log_histogram_sort(&s->peak, &peak, err)) {
        free(level);
        return -1;
    }
    if (s->peak.n) {
        lo = fl_log_bin_lower(peak[0].key);
        hi = fmin(fl_log_bin_upper(peak[s->peak.n - 1].key), s->max);
    }
    fl_summary_moments(s, moment);
    label(f, s);
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
    putc('\n', f);
    free(level);
    free(peak);
    return 0;
}

static int stats_rows(FILE *f, const fl_summary *sum, const struct options *o, fl_err *err)
{
    for (int32_t k = 0; k < sum->n; k++)
        if (stats_row(f, &sum->entry[k], o, err)) return -1;
    return 0;
}

/* --- the ensemble --------------------------------------------------------------------------------------- */

/* Mean and largest value of each run, in the order of the files. */
typedef struct {
    int32_t runs, cap, signals;
    double *x; /* [runs][signals][2] */
} ensemble;

static int ensemble_add(ensemble *e, const fl_summary *all, const fl_summary *one, const char *name,
                        fl_err *err)
{
    if (e->runs == 0) e->signals = one->n;
    if (one->n != e->signals || all->n != e->signals)
        return fl_fail(err, FL_INPUT, "%s: its parts and signals are not those of the runs before", name);
    if (fl_grow(&e->x, &e->cap, 2 * ((int64_t)e->runs + 1) * e->signals, sizeof *e->x, err)) return -1;
    double *x = e->x + 2 * (int64_t)e->runs * e->signals;
    for (int32_t k = 0; k < e->signals; k++) {
        const fl_summary_signal *s = &one->entry[k];
        if (fl_multiset_size(&s->run[FL_RUN_MEAN]) != 1)
            return fl_fail(err, FL_INPUT, "%s: a summary of several runs, which cannot be told apart", name);
        *x++ = s->run[FL_RUN_MEAN].v[0].x;
        *x++ = s->run[FL_RUN_MAX].v[0].x;
    }
    e->runs++;
    return 0;
}

static void put_estimate(FILE *f, const fl_mean_interval *e)
{
    write_cell(f, e->mean);
    write_cell(f, e->low);
    write_cell(f, e->high);
    write_cell(f, e->std);
}

static int ensemble_rows(FILE *f, const ensemble *e, const fl_summary *all, fl_err *err)
{
    double *mean = fl_alloc(2 * (int64_t)e->runs, sizeof *mean, err), *max = mean + e->runs;
    if (!mean) return -1;
    for (int32_t k = 0; k < e->signals; k++) {
        double largest = -INFINITY;
        for (int32_t n = 0; n < e->runs; n++) {
            mean[n] = e->x[2 * ((int64_t)n * e->signals + k)];
            max[n] = e->x[2 * ((int64_t)n * e->signals + k) + 1];
            const fl_mean_interval a = fl_mean_interval_of(n + 1, mean), b = fl_mean_interval_of(n + 1, max);
            largest = fmax(largest, max[n]);
            label(f, &all->entry[k]);
            fprintf(f, "\t%d", n + 1);
            put_estimate(f, &a);
            put_estimate(f, &b);
            write_cell(f, largest);
            putc('\n', f);
        }
    }
    free(mean);
    return 0;
}

/* What a picture shows of one signal. */
static int plot_rows(FILE *f, const ensemble *e, int32_t k, fl_err *err)
{
    double *mean = fl_alloc(2 * (int64_t)e->runs, sizeof *mean, err), *max = mean + e->runs,
           largest = -INFINITY;
    if (!mean) return -1;
    for (int32_t n = 0; n < e->runs; n++) {
        mean[n] = e->x[2 * ((int64_t)n * e->signals + k)];
        max[n] = e->x[2 * ((int64_t)n * e->signals + k) + 1];
        const fl_mean_interval a = fl_mean_interval_of(n + 1, mean), b = fl_mean_interval_of(n + 1, max);
        largest = fmax(largest, max[n]);
        fprintf(f, "%d", n + 1);
        write_cell(f, a.mean);
        write_cell(f, a.low);
        write_cell(f, a.high);
        write_cell(f, b.mean);
        write_cell(f, b.low);
        write_cell(f, b.high);
        write_cell(f, largest);
        putc('\n', f);
    }
    free(mean);
    return 0;
}

/* Time and peaks of the classes of the values, as the table histogram has them. */
static int histogram_rows(FILE *f, const fl_summary_signal *s, fl_err *err)
{
    fl_log_bin *level = NULL, *peak = NULL;
    if (fl_log_histogram_sort(&s->level, &level, err) || fl_log_histogram_sort(&s->peak, &peak, err)) {
        free(level);
        return -1;
    }
    const double total = fl_exact_value(&s->sum[0]);
    for (int32_t k = 0, j = 0; k < s->level.n; k++) {
        /* A peak is a value, so its class is among those of the values. */
        while (j < s->peak.n && peak[j].key < level[k].key) j++;
        const int64_t peaks = j < s->peak.n && peak[j].key == level[k].key ? peak[j].n : 0;
        const double time = fl_fixed_time_seconds(level[k].time);
        label(f, s);
        fputs("\traw", f);
        write_cell(f, fl_log_bin_lower(level[k].key));
        write_cell(f, fl_log_bin_upper(level[k].key));
        write_cell(f, time);
        write_cell(f, time / total);
        fprintf(f, "\t%lld\n", (long long)peaks);
    }
    free(level);
    free(peak);
    return 0;
}

/* Laws of the largest values of the blocks, or of the runs, one beside the other as if they were one record.
 */
static int fit_rows(FILE *f, const fl_summary *all, const fl_summary_signal *s, const struct options *o,
                    fl_err *err)
{
    const int runs = o->sample == SAMPLE_RUNS || !(all->settings.block > 0.0);
    const fl_multiset *bag = runs ? &s->run[FL_RUN_MAX] : &s->block;
    const int64_t n = fl_multiset_size(bag);
    struct options own = *o;
    own.sample = runs ? SAMPLE_RUNS : SAMPLE_BLOCKS;
    own.block = runs ? fl_exact_value(&s->sum[0]) / (double)n : all->settings.block;
    if (n < 1 || n > INT32_MAX / 4)
        return fl_fail(err, FL_INPUT, "%s of %s has %lld maxima of blocks, some are expected", s->signal,
                       s->part, (long long)n);
    double *x = fl_alloc(2 * n + 1, sizeof *x, err), *edge = x + n;
    if (!x) return -1;
    for (int32_t k = 0, i = 0; k < bag->n; k++)
        for (int64_t j = 0; j < bag->v[k].count; j++) x[i++] = bag->v[k].x;
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
    const fl_signal_view view = {.n = (int32_t)n, .t = edge, .edge = edge, .x = x};
    const struct result r = {.s = &series, .views = &view, .each = 1};
    const int rc = fits_write(f, &r, &own, 0, 0, 0, err);
    free(x);
    return rc;
}

/* Load cycles by classes of their range. */
static int cycle_rows(FILE *f, const fl_summary *all, const fl_summary_signal *s, fl_err *err)
{
    fl_log_bin *sorted;
    if (fl_log_histogram_sort(&s->cycle, &sorted, err)) return -1;
    for (int32_t k = 0; k < s->cycle.n; k++) {
        label(f, s);
        rainflow_write_rule(f, all->settings.rule, all->settings.residue);
        write_cell(f, fl_log_bin_lower(sorted[k].key));
        write_cell(f, fl_log_bin_upper(sorted[k].key));
        write_cell(f, 0.5 * (double)sorted[k].n);
        putc('\n', f);
    }
    free(sorted);
    return 0;
}

/* Damage of the cycles of all runs, each taken for the middle of its class. */
static int damage_rows(FILE *f, const fl_summary *all, const fl_summary_signal *s, const struct options *o,
                       fl_err *err)
{
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

static int one_by_one(FILE *f, const fl_summary *all, fl_summary_signal *s, const struct options *o,
                      fl_err *err)
{
    fl_multiset_sort(&s->block); /* whatever the order of the files */
    fl_multiset_sort(&s->run[FL_RUN_MAX]);
    if (o->table == TABLE_HISTOGRAM) return histogram_rows(f, s, err);
    if (o->table == TABLE_DAMAGE) return damage_rows(f, all, s, o, err);
    return o->table == TABLE_CYCLES ? cycle_rows(f, all, s, err) : fit_rows(f, all, s, o, err);
}

static int write_rows(FILE *f, fl_summary *all, const ensemble *e, const struct options *o, fl_err *err)
{
    if (o->table == TABLE_SUMMARY) return fl_summary_write(f, all, err);
    if (o->table == TABLE_ENSEMBLE) return ensemble_rows(f, e, all, err);
    if (o->table == TABLE_STATS) return stats_rows(f, all, o, err);
    for (int32_t k = 0; k < all->n; k++)
        if (one_by_one(f, all, &all->entry[k], o, err)) return -1;
    return 0;
}

/* --- reading -------------------------------------------------------------------------------------------- */

/* Rows of a record that is still growing, whenever its data have gone on by o->follow seconds. */
static int follow(FILE *f, fl_run *run, const struct options *o, double *next, fl_err *err)
{
    if (run->end < *next) return 0;
    while (*next <= run->end) *next += o->follow;
    if (fl_run_update(run, err) || stats_rows(f, &run->sum, o, err)) return -1;
    return fflush(f) == 0 ? 0 : fl_fail(err, FL_SYSTEM, "%s: could not write all of it", o->out);
}

static void write_header(FILE *f, const char *history, const struct options *o)
{
    fl_history_line by;
    if (o->table == TABLE_SUMMARY) return; /* it has its own */
    history_line_run(o, &by);
    fl_write_file_header(f, options_table(o->table), 1, history, &by);
    if (o->table == TABLE_ENSEMBLE)
        fputs("part\tsignal\tunit\truns\tmean\tmean_low\tmean_high\tmean_std\tmax\tmax_low\tmax_high\tmax_std"
              "\tlargest\n",
              f);
    else if (o->table == TABLE_CYCLES) fputs("part\tsignal\tunit\trule\tresidue\tfrom\tto\tcycles\n", f);
    else stats_header(f, o);
}

static int read_run(fl_summary *one, const char *path, FILE *f, const struct options *o, const char *by,
                    fl_err *err)
{
    const fl_record_selection ask = {.signal = o->signal,
                                     .signals = o->signals,
                                     .part = o->part,
                                     .from = options_from(o),
                                     .to = o->to,
                                     .reduction = o->over,
                                     .where = o->where,
                                     .wheres = o->wheres,
                                     .patience = o->follow > 0.0 ? o->patience : 0.0};
    const fl_summary_settings how = {.separation = o->separation,
                                     .threshold = o->threshold,
                                     .block = o->block,
                                     .rule = o->rule,
                                     .residue = o->residue};
    fl_run run = {0};
    double next = NAN;
    int more, rc = -1;
    if (fl_run_open(&run, path, &ask, &how, err)) goto done;
    while ((more = fl_run_next(&run, err)) > 0) {
        if (!(o->follow > 0.0)) continue;
        /* Rows are told at whole multiples of the interval, whenever the record began. */
        if (isnan(next)) {
            write_header(f, fl_record_history(&run.record), o);
            next = o->follow * (floor(run.record.edge[0] / o->follow) + 1.0);
        }
        if (follow(f, &run, o, &next, err)) goto done;
    }
    if (more < 0 || fl_run_finish(&run, by, err)) goto done;
    rc = fl_summary_merge(one, &run.sum, path, err);
done:
    fl_run_close(&run);
    return rc;
}

static int read_all(fl_summary *all, ensemble *e, FILE *f, const struct options *o, fl_err *err)
{
    char by[FL_HISTORY_LINE_MAX + 2] = "";
    /* The line that ends a chain is that of the summary; a table of one record has its own line only. */
    if (o->table == TABLE_SUMMARY || o->files > 1) history_line_summary(o, by);
    for (int k = 0; k < o->files; k++) {
        const char *path = o->file[k];
        fl_summary one = {0};
        int rc = o->merge ? fl_summary_read(&one, path, err) : read_run(&one, path, f, o, by, err);
        if (rc == 0) rc = fl_summary_merge(all, &one, path, err);
        if (rc == 0 && o->table == TABLE_ENSEMBLE) rc = ensemble_add(e, all, &one, path, err);
        fl_summary_free(&one);
        if (rc) return -1;
    }
    return 0;
}

/* Two runs of one history are one run counted twice, and make intervals too narrow. */
static void warn(const fl_summary *all, const struct options *o)
{
    int64_t chains = 0, runs = 0;
    int told = 0;
    for (const char *p = all->history; p && *p; p = strchr(p, '\n') + 1) {
        const char *end = strchr(p, '\n'), *mark = strstr(p, " --summary");
        if (!end) break;
        if (mark && mark < end) chains++;
        else told = 1;
    }
    for (int32_t k = 0; k < all->n; k++) {
        const int64_t n = fl_multiset_size(&all->entry[k].run[FL_RUN_MEAN]);
        if (n > runs) runs = n;
    }
    if (!o->quiet && told && runs > chains && chains > 0)
        fprintf(stderr, "loadstats: %lld runs have %lld %s: some are the same run, counted twice\n",
                (long long)runs, (long long)chains, chains == 1 ? "history" : "histories");
}

/* --- report and pictures -------------------------------------------------------------------------------- */

typedef struct {
    fl_summary *all;
    const ensemble *e;
} many;

static void many_intro(FILE *f, const void *what)
{
    const many *m = what;
    const fl_summary_signal *s = &m->all->entry[0];
    fprintf(f,
            "%d runs of %lld rows and %.6g s in all, from %.6g s to %.6g s of a run. Every mean is the "
            "impulse over "
            "the time; what runs differ by is told with the estimates.",
            m->e->runs, (long long)s->rows, fl_exact_value(&s->sum[0]), s->from, s->to);
}

static int many_table(FILE *f, const void *what, const struct options *o, fl_err *err)
{
    const many *m = what;
    write_header(f, m->all->history, o);
    return write_rows(f, m->all, m->e, o, err);
}

/* Mean and largest values with their intervals against the number of runs. */
static const char SCRIPT[] =
    "set border 3 lc rgb '#444444'\n"
    "set tics nomirror out scale 0.6 textcolor rgb '#222222'\n"
    "set datafile missing '-'\nset encoding utf8\nset multiplot\nset yrange [*:*]\nset xlabel 'Runs'\n"
    "set key at graph 0.98, 0.98 right top samplen 2\n";

static void put_panel(FILE *f, const char *title, int first, double left, double right, int largest)
{
    fprintf(f, "set lmargin at screen %g\nset rmargin at screen %g\nset tmargin at screen 0.86\n", left,
            right);
    fprintf(f, "set bmargin at screen 0.2\nset title '%s'\n", title);
    fprintf(
        f,
        "plot data using 1:(factor*$%d):(factor*$%d) with filledcurves lc rgb '#c6dbef' title '95 %%', \\\n",
        first + 1, first + 2);
    fprintf(f, "     '' using 1:(factor*$%d) with lines lw 2 lc rgb '#08519c' title 'mean of the runs'",
            first);
    if (largest)
        fputs(", \\\n     '' using 1:(factor*$8) with steps lw 1.5 lc rgb '#c8642d' title 'largest of all'",
              f);
    fputs("\n", f);
}

static int draw_signal(const many *m, int32_t k, const struct options *o, const fl_history_line *by,
                       fl_err *err)
{
    const fl_summary_signal *s = &m->all->entry[k];
    const int newton = s->unit[0] == 'N', png = strcmp(o->format, "png") == 0;
    const double large = fmax(fabs(s->min), fabs(s->max));
    const char *prefix = !newton || large < 1e3 ? "" : large < 1e6 ? "k" : "M";
    char stem[60], path[PATH_LEN];
    fl_out out = {0};
    int rc = -1;
    snprintf(stem, sizeof stem, "ensemble-%d", k + 1);
    if (snprintf(path, sizeof path, "%s/%s.tsv", o->plot, stem) >= PATH_LEN)
        return fl_fail(err, FL_SYSTEM, "the name of a picture in %.100s is too long", o->plot);
    if (fl_out_open(&out, path, 0, err)) goto done;
    fl_write_file_header(out.f, "ensemble", 1, m->all->history, by);
    fputs("runs\tmean\tmean_low\tmean_high\tmax\tmax_low\tmax_high\tlargest\n", out.f);
    if (plot_rows(out.f, m->e, k, err) || fl_out_close(&out, err)) goto done;
    snprintf(path, sizeof path, "%.4000s/%s.gp", o->plot, stem);
    if (fl_out_open(&out, path, 0, err)) goto done;
    fprintf(out.f, "# gnuplot %s.gp draws %s.%s from %s.tsv\nif (!exists(\"out\")) out = '%s.%s'\n", stem,
            stem, o->format, stem, stem, o->format);
    fputs(
        png ? "set terminal pngcairo noenhanced size 1000,380 font 'Sans,11' background '#ffffff'\n"
            : "set terminal svg noenhanced size 1000,380 dynamic font 'sans-serif,14' background '#ffffff'\n",
        out.f);
    fprintf(out.f, "set output out\ndata = '%s.tsv'\nfactor = %s\n%s", stem,
            prefix[0] == 'k'   ? "1e-3"
            : prefix[0] == 'M' ? "1e-6"
                               : "1",
            SCRIPT);
    /* A few runs say so little that their intervals would hide the rest. */
    fprintf(out.f, "set xrange [%d:%d]\nset ylabel ", m->e->runs > 8 ? 4 : 1,
            m->e->runs > 1 ? m->e->runs : 2);
    char text[300];
    snprintf(text, sizeof text, "%.80s, %.80s  %s%s%.60s%s", s->signal, s->part, s->unit[0] ? "[" : "",
             prefix, s->unit, s->unit[0] ? "]" : "");
    plot_quoted(out.f, text);
    putc('\n', out.f);
    put_panel(out.f, "Mean of a run", 2, 0.085, 0.48, 0);
    fputs("unset ylabel\nset key at graph 0.98, 0.75\n", out.f); /* below the largest, above the means */
    put_panel(out.f, "Largest value of a run", 5, 0.575, 0.97, 1);
    fputs("unset multiplot\nset output\n", out.f);
    if (fl_out_close(&out, err)) goto done;
    rc = plot_draw(o->plot, stem, o->format, err);
done:
    fl_out_abort(&out);
    return rc;
}

static int many_draw(const void *what, const struct options *o, fl_err *err)
{
    const many *m = what;
    fl_history_line by;
    history_line_run(o, &by);
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    if (m->all->n > PICTURES_MAX)
        return fl_fail(err, FL_USAGE, "at most %d signals are drawn, here are %d: choose some", PICTURES_MAX,
                       m->all->n);
    for (int32_t k = 0; k < m->all->n; k++)
        if (draw_signal(m, k, o, &by, err)) return -1;
    return 0;
}

int summary_run(const struct options *o, fl_err *err)
{
    fl_summary all = {0};
    ensemble e = {0};
    fl_out out = {0};
    const many m = {&all, &e};
    int rc = -1;
    /* What is followed is written as it comes; all else when it has been read. */
    if (o->follow > 0.0 && fl_out_open(&out, o->out, o->gzip, err)) goto done;
    if (read_all(&all, &e, out.f, o, err)) goto done;
    warn(&all, o);
    if (!(o->follow > 0.0)) {
        if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
        write_header(out.f, all.history, o);
    }
    if (write_rows(out.f, &all, &e, o, err)) goto done;
    if (fl_out_close(&out, err)) goto done;
    if (o->plot && many_draw(&m, o, err)) goto done;
    rc = 0;
    if (o->report) {
        const report_source from = {.what = &m,
                                    .many = 1,
                                    .title = "Ice loads of many runs",
                                    .history = all.history,
                                    .span = all.n ? fl_exact_value(&all.entry[0].sum[0]) : 0.0,
                                    .intro = many_intro,
                                    .table = many_table,
                                    .draw = many_draw};
        rc = html_report_write(&from, o, err);
    }
done:
    fl_out_abort(&out);
    free(e.x);
    fl_summary_free(&all);
    return rc;
}
