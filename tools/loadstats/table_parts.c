/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <string.h>
#include "base/stream.h"
#include "stat/event.h"
#include "table_parts.h"
#include "plot.h"

enum { HEAD = 74, PANEL = 230 };

/* What parts are compared by: the total is in the list of parts, but is none. */
typedef struct {
    int32_t total;              /* its place in the list of parts, -1 for none */
    double most_mean, most_max; /* of all parts: the mean that is largest in size, the largest value */
    double sum_max;             /* sum of the largest values of the parts */
    int32_t at;                 /* row of the largest total */
} comparison;

static comparison compare(const struct result *r, int32_t s, int w)
{
    const int32_t last = r->s->parts - 1;
    const fl_signal_view *total = strcmp(r->s->part[last], "total") == 0 ? view_of(r, last, s, w) : NULL;
    comparison c = {.total = last > 0 && total ? last : -1, .at = -1, .most_max = -INFINITY};
    for (int32_t p = 0; p < r->s->parts; p++) {
        const fl_signal_view *v = p == c.total ? NULL : view_of(r, p, s, w);
        if (!v) continue;
        if (fabs(v->stats.mean) > fabs(c.most_mean)) c.most_mean = v->stats.mean;
        c.most_max = fmax(c.most_max, v->stats.max);
        c.sum_max += v->stats.max;
    }
    if (c.total >= 0) c.at = total->stats.at_max;
    return c;
}

/* A ratio to something that is no load is none. */
static double ratio(double x, double of) { return of != 0.0 && isfinite(of) ? x / of : (double)NAN; }

static void leg_row(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s, int w)
{
    const fl_signal_view *v = view_of(r, p, s, w);
    const comparison c = compare(r, s, w);
    const fl_descriptive_stats *d = &v->stats;
    const int32_t n = v->peaks.n;
    const int loaded = d->max > 0.0, whole = p == c.total;
    const double level = o->level * d->max;
    double rise = 0.0, duration = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_event e = fl_event_of(v->n, v->x, v->edge, &v->peaks, k, o->level);
        rise += e.rise / n;
        duration += e.duration / n;
    }
    const double there = c.at >= 0 ? v->x[c.at] : (double)NAN;
    write_labels(f, r, p, s, w);
    write_cell(f, d->mean);
    write_cell(f, d->std);
    write_cell(f, d->min);
    write_cell(f, d->max);
    write_cell(f, v->t[d->at_max]);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 1.0 / 3.0) : NAN);
    write_cell(f, n ? fl_mean_of_highest(n, v->peak_value, 0.1) : NAN);
    write_cell(f, fl_event_impulse(v->n, v->x, v->edge));
    write_cell(f, loaded ? fl_event_time_above(v->n, v->x, v->edge, level) : NAN);
    fprintf(f, "\t%d", n);
    write_cell(f, n ? rise : NAN);
    write_cell(f, n ? duration : NAN);
    write_cell(f, whole ? NAN : ratio(d->mean, c.most_mean));
    write_cell(f, whole || !(c.most_max > 0.0) ? NAN : ratio(d->max, c.most_max));
    write_cell(f, there);
    write_cell(f, !loaded ? NAN : whole ? ratio(d->max, c.sum_max) : ratio(there, d->max));
    putc('\n', f);
}

static void event_rows(FILE *f, const struct result *r, const struct options *o, int32_t p, int32_t s, int w)
{
    const fl_signal_view *v = view_of(r, p, s, w);
    for (int32_t k = 0; k < v->peaks.n; k++) {
        const fl_event e = fl_event_of(v->n, v->x, v->edge, &v->peaks, k, o->level);
        write_labels(f, r, p, s, w);
        write_cell(f, v->t[e.peak]);
        write_cell(f, v->x[e.peak]);
        write_cell(f, v->edge[e.first]);
        write_cell(f, v->edge[e.last + 1]);
        write_cell(f, e.rise);
        write_cell(f, e.fall);
        write_cell(f, e.duration);
        write_cell(f, e.impulse);
        putc('\n', f);
    }
}

void parts_header(FILE *f, const struct options *o)
{
    if (o->table == TABLE_EVENTS) {
        fputs("\tt[s]\tpeak\tfrom[s]\tto[s]\trise[s]\tfall[s]\tduration[s]\timpulse\n", f);
        return;
    }
    fputs("\tmean\tstd\tmin\tmax\tt_max[s]\tpeak_third\tpeak_tenth\timpulse\tabove[s]\tpeaks\trise[s]"
          "\tduration[s]\tmean_ratio\tmax_ratio\tat_total\tsimultaneity\n",
          f);
}

void parts_write(FILE *f, const struct result *r, const struct options *o)
{
    const int32_t parts = r->s->parts, signals = r->s->signals;
    for (int32_t k = 0; k < parts * signals; k++) {
        /* Legs are compared signal by signal; events follow the order of all other tables. */
        const int legs = o->table == TABLE_LEGS;
        const int32_t p = legs ? k % parts : k / signals, s = legs ? k / parts : k % signals;
        for (int w = 0; w < r->each && view_of(r, p, s, 0); w++) {
            if (legs) leg_row(f, r, o, p, s, w);
            else event_rows(f, r, o, p, s, w);
        }
    }
}

/* --- picture -------------------------------------------------------------------------------------------- */

/* The data of a picture: a block a signal, a row a part. */
static void plot_data(FILE *f, const struct result *r, int32_t s)
{
    const comparison c = compare(r, s, 0);
    fputs("\n\n", f); /* two blank lines part the blocks; the names of the columns are the first one */
    for (int32_t p = 0; p < r->s->parts; p++) {
        const fl_signal_view *v = view_of(r, p, s, 0);
        if (!v) continue;
        fprintf(f, "%s\t%s", r->s->part[p], r->s->signal[s]);
        write_cell(f, v->stats.mean);
        write_cell(f, v->peaks.n ? fl_mean_of_highest(v->peaks.n, v->peak_value, 1.0 / 3.0) : NAN);
        write_cell(f, v->stats.max);
        write_cell(f, fmin(v->stats.min, 0.0));
        write_cell(f, c.at >= 0 && p != c.total ? v->x[c.at] : (double)NAN);
        putc('\n', f);
    }
}

static void plot_panel(FILE *f, const struct result *r, int32_t s, int index, int panels, int height)
{
    double large = 0.0;
    int32_t bars = 0;
    char text[300];
    for (int32_t p = 0; p < r->s->parts; p++) {
        const fl_signal_view *v = view_of(r, p, s, 0);
        if (!v) continue;
        large = fmax(large, fmax(fabs(v->stats.min), fabs(v->stats.max)));
        bars++;
    }
    const plot_scale c = plot_scale_of(r->s->unit[s], large);
    plot_axis(text, sizeof text, r->s->signal[s], r->s->unit[s], large);
    const double top = (double)HEAD + index * PANEL, bottom = top + PANEL - 60.0;
    fprintf(f, "set tmargin at screen %.4f\nset bmargin at screen %.4f\nset xrange [-0.6:%g]\nset ylabel ",
            1.0 - top / height, 1.0 - bottom / height, bars - 0.4);
    plot_quoted(f, text);
    fprintf(f, "\nfactor = %g\nblock = %d\n", c.factor, index + 1);
    fputs("plot data index block using ($0-0.24):(factor*$3):(0.22) with boxes ls 1 title 'mean', \\\n"
          "     '' index block using 0:(factor*$4):(0.22):xtic(1) with boxes ls 2 title 'third of the "
          "peaks', \\\n"
          "     '' index block using ($0+0.24):(factor*$5):(0.22) with boxes ls 3 title 'extremes', "
          "\\\n"
          "     '' index block using ($0+0.24):(factor*$6):(0.22) with boxes ls 3 notitle, \\\n"
          "     '' index block using 0:(factor*$7) with points ls 4 title 'at largest total'\n",
          f);
    if (index == 0) fputs("unset key\nunset label 1\n", f);
    if (index + 1 == panels) fputs("unset multiplot\nset output\n", f);
}

static void plot_script(FILE *f, const struct result *r, const struct options *o, int panels)
{
    const int png = strcmp(o->format, "png") == 0, height = HEAD + panels * PANEL;
    int index = 0;
    plot_open(f, "legs", o->format, 1000, height);
    fputs(
        "set style line 1 lc rgb '#9ecae1'\nset style line 2 lc rgb '#4292c6'\nset style line 3 lc rgb "
        "'#08519c'\nset style line 4 lc rgb '#c8642d' pt 7 ps 0.9\nset style fill solid 1.0 noborder\n"
        "set border 3 lc rgb '#444444' lw 1\nset tics nomirror out scale 0.6 textcolor rgb '#222222'\nset "
        "datafile separator '\\t'\nset datafile missing '-'\nset multiplot\nset lmargin at screen 0.095\n"
        "set rmargin at screen 0.97\nset xtics scale 0\nset xzeroaxis lc rgb '#444444' lw 1\nset grid ytics "
        "back lc rgb '#dddddd' lw 0.8\n",
        f);
    fprintf(f, "set label 1 'Parts side by side' at screen 0.095, screen %.4f left font ',%d'\n",
            1.0 - 24.0 / height, png ? 14 : 18);
    fprintf(f,
            "set key at screen 0.975, screen %.4f right top horizontal Left reverse samplen 1 width -3 "
            "maxrows 1\n",
            1.0 - 34.0 / height);
    for (int32_t s = 0; s < r->s->signals; s++)
        if (view_of(r, 0, s, 0)) plot_panel(f, r, s, index++, panels, height);
}

int plot_parts(const struct result *r, const struct options *o, const fl_history_line *by, fl_err *err)
{
    char path[PLOT_PATH_LEN];
    fl_out out = {0};
    int panels = 0, rc = -1;
    if (plot_path(path, o->plot, "legs", "tsv", err) || fl_out_open(&out, path, 0, err)) goto done;
    fl_write_file_header(out.f, "legs", 1, r->s->history, by);
    fputs("part\tsignal\tmean\tpeak_third\tmax\tmin\tat_total\n", out.f);
    for (int32_t s = 0; s < r->s->signals; s++) {
        if (!view_of(r, 0, s, 0)) continue;
        plot_data(out.f, r, s);
        panels++;
    }
    if (fl_out_close(&out, err)) goto done;
    if (plot_path(path, o->plot, "legs", "gp", err) || fl_out_open(&out, path, 0, err)) goto done;
    plot_script(out.f, r, o, panels);
    if (fl_out_close(&out, err)) goto done;
    rc = plot_draw(o->plot, "legs", o->format, err);
done:
    fl_out_abort(&out);
    return rc;
}
