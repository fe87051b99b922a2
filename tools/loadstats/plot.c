/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "stat/power_spectrum.h"
#include "plot_rainflow.h"
#include "plot_levels.h"
#include "table_parts.h"
#include "plot.h"
#include "plot_spectrum.h"
#include "plot_response.h"

enum { PARTS_MAX = 24, GAP = 26, STRETCHES = 2000, CLASSES = 20, ALL_RANKS = 200 };

/* A filter leaves a constant with the rounding of its sums; no axis has more digits than this. */
static const double FLAT = 1e-6;

/* --- data ----------------------------------------------------------------------------------------------- */

static void history_row(const picture *p, int32_t s, int w, double t, double x)
{
    plot_label(p, s, w);
    plot_columns(p, 2, (double[]){t, x});
}

/* A row of a loads table is the mean of an interval: a step where there is room for it, else its middle. */
static void history_block(picture *p, int32_t s, int w)
{
    const fl_signal_view *v = view_of(p->r, p->part, s, w);
    const int means = strcmp(p->r->s->kind, "loads") == 0, steps = means && w == 0 && v->n <= STRETCHES;
    const int64_t stretches = v->n > 2 * STRETCHES ? STRETCHES : v->n;
    plot_block(p);
    for (int32_t k = 0; steps && k < v->n; k++) {
        history_row(p, s, w, v->edge[k], v->x[k]);
        history_row(p, s, w, v->edge[k + 1], v->x[k]);
    }
    for (int64_t j = 0; !steps && j < stretches; j++) {
        const int32_t from = (int32_t)(j * v->n / stretches), to = (int32_t)((j + 1) * v->n / stretches);
        int32_t k[2] = {from, from};
        for (int32_t i = from; i < to; i++) {
            if (v->x[i] < v->x[k[0]]) k[0] = i;
            if (v->x[i] > v->x[k[1]]) k[1] = i;
        }
        const int later = k[0] < k[1], single = k[0] == k[1];
        for (int i = 0; i < 2 - single; i++) {
            const int32_t row = k[i ? later : !later];
            history_row(p, s, w, means ? 0.5 * (v->edge[row] + v->edge[row + 1]) : v->t[row], v->x[row]);
        }
    }
}

/* All of the largest, then in steps of a hundredth of the rank: no picture shows more. */
static int32_t next_rank(int32_t k) { return k < ALL_RANKS ? k + 1 : k + k / (ALL_RANKS / 2); }

static void exceedance_block(picture *p, int32_t s, int w)
{
    const fl_signal_view *v = view_of(p->r, p->part, s, w);
    const int32_t n = v->peaks.n;
    plot_block(p);
    for (int32_t k = 0; k < n; k = next_rank(k)) {
        plot_label(p, s, w);
        plot_columns(p, 3,
                     (double[]){v->peak_value[k], fl_plotting_position(k + 1, n),
                                v->t[v->peaks.row[v->peak_rank[k]]]});
    }
}

static void classes_block(picture *p, int32_t s, int w, const fl_histogram *h)
{
    plot_block(p);
    for (int32_t k = 0; k < h->n; k++) {
        plot_label(p, s, w);
        plot_columns(
            p, 3,
            (double[]){0.5 * (h->range[k] + h->range[k + 1]), h->bin[k], h->range[k + 1] - h->range[k]});
    }
}

static void history_panel(picture *p, int k, int32_t s)
{
    const struct result *r = p->r;
    const fl_signal_view *v = view_of(r, p->part, s, 0);
    const plot_scale c = plot_scale_here(p, s);
    double lo = v->stats.min, hi = v->stats.max;
    char text[300];
    for (int w = 1; w < r->each; w++) {
        lo = fmin(lo, view_of(r, p->part, s, w)->stats.min);
        hi = fmax(hi, view_of(r, p->part, s, w)->stats.max);
    }
    if (!(hi - lo > FLAT * fmax(fabs(lo), fabs(hi)))) { /* a constant has no range of its own */
        const double room = lo != 0.0 ? 0.5 * fabs(lo) : 1.0;
        lo -= room;
        hi += room;
    }
    plot_place(p, k, 0.095, 0.97);
    fprintf(p->script, "set xrange [%.10g:%.10g]\n", v->edge[0], v->edge[v->n]);
    fprintf(p->script, "set yrange [%.10g:%.10g]\nset ytics %.6g\n", c.factor * (lo - 0.04 * (hi - lo)),
            c.factor * (hi + 0.04 * (hi - lo)), plot_tics(c.factor * (hi - lo)));
    plot_axis_text(p, s, text, sizeof text);
    plot_left_title(p, text, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Time  [s]'\nset format x '%g'\n", p->script);
    else fputs("set format x ''\n", p->script);
    for (int w = 0; w < r->each; w++) {
        plot_curve(p);
        fprintf(p->script, "using 4:($5*%g) with lines ls %d title '%s", c.factor, r->each > 1 ? w + 1 : 3,
                view_name(w));
        if (w) {
            options_filter(p->o, text, sizeof text);
            fprintf(p->script, ", %s'", text);
        }
        if (!w) putc('\'', p->script);
        history_block(p, s, w);
    }
    plot_end_panel(p);
}

static int history(picture *p, fl_err *err)
{
    int k = 0;
    (void)err;
    p->gap = GAP;
    for (int32_t s = 0; s < p->r->s->signals; s++) p->panels += view_of(p->r, p->part, s, 0) != NULL;
    fputs("signal\tunit\tview\tt[s]\tvalue\n", p->data);
    plot_start(p, plot_is_loads(p) ? "Load history" : "History");
    for (int32_t s = 0; s < p->r->s->signals; s++)
        if (view_of(p->r, p->part, s, 0)) history_panel(p, k++, s);
    return 0;
}

/* Peaks of a signal in any of its views? */
static int32_t peaks_of(const picture *p, int32_t s)
{
    int32_t n = 0;
    for (int w = 0; view_of(p->r, p->part, s, 0) && w < p->r->each; w++)
        n += view_of(p->r, p->part, s, w)->peaks.n;
    return n;
}

/* Left, how many peaks there are in each class; both views share the classes. */
static int classes_panel(picture *p, int k, int32_t s, fl_err *err)
{
    const struct result *r = p->r;
    const plot_scale c = plot_scale_here(p, s);
    fl_histogram h[2] = {{0}, {0}};
    double lo = INFINITY, hi = -INFINITY, most = 0.0;
    char text[300];
    int rc = -1;
    for (int w = 0; w < r->each; w++) {
        const fl_signal_view *v = view_of(r, p->part, s, w);
        if (!v->peaks.n) continue;
        hi = fmax(hi, v->peak_value[0]);
        lo = fmin(lo, v->peak_value[v->peaks.n - 1]);
    }
    for (int w = 0; w < r->each; w++) {
        const fl_signal_view *v = view_of(r, p->part, s, w);
        if (fl_histogram_make(&h[w], CLASSES, lo, hi, err)) goto done;
        for (int32_t i = 0; i < v->peaks.n; i++) fl_histogram_add(&h[w], v->peak_value[i], 1.0);
        for (int32_t i = 0; i < CLASSES; i++) most = fmax(most, h[w].bin[i]);
    }
    plot_place(p, k, 0.1, 0.475);
    plot_axis_text(p, s, text, sizeof text);
    fputs("set xlabel ", p->script);
    plot_quoted(p->script, text);
    putc('\n', p->script);
    fprintf(p->script, "set xtics %.6g\n", plot_tics(c.factor * (h[0].range[CLASSES] - h[0].range[0])));
    plot_left_title(p, "Peaks in class", 0.018);
    fprintf(p->script, "unset logscale y\nset yrange [0:%g]\nset ytics %g\n", 1.08 * most,
            fmax(1.0, plot_tics(most)));
    for (int w = 0; w < r->each; w++) {
        plot_curve(p);
        fprintf(p->script,
                "using ($4*%g):5:($6*%g) with boxes fill solid 1.0 noborder lc rgb '%s' title '%s'", c.factor,
                c.factor * (w ? 0.45 : 0.92), r->each > 1 ? (w ? "#08519c" : "#9ecae1") : "#2171b5",
                view_name(w));
        classes_block(p, s, w, &h[w]);
    }
    plot_end_panel(p);
    rc = 0;
done:
    fl_histogram_free(&h[0]);
    fl_histogram_free(&h[1]);
    return rc;
}

/* Right, how probable it is that a peak is larger. */
static void exceedance_panel(picture *p, int k, int32_t s)
{
    const plot_scale c = plot_scale_here(p, s);
    plot_place(p, k, 0.58, 0.97);
    plot_left_title(p, "Probability of exceedance", 0.508);
    fputs("set xtics autofreq\nset logscale y\nset yrange [*:1]\nset ytics "
          "autofreq\nset "
          "format y '%g'\n",
          p->script);
    for (int w = 0; w < p->r->each; w++) {
        if (!view_of(p->r, p->part, s, w)->peaks.n) continue;
        plot_curve(p);
        fprintf(p->script, "using ($4*%g):5 with points ls %d title '%s'", c.factor,
                p->r->each > 1 ? w + 1 : 3, view_name(w));
        exceedance_block(p, s, w);
    }
    plot_end_panel(p);
}

static int peaks(picture *p, fl_err *err)
{
    int k = 0;
    p->gap = PLOT_FOOT + 10;
    for (int32_t s = 0; s < p->r->s->signals; s++) p->panels += peaks_of(p, s) > 0;
    fputs("signal\tunit\tview\tpeak\tcount_or_P\twidth_or_t\n", p->data);
    plot_start(p, plot_is_loads(p) ? "Load peaks" : "Peaks");
    for (int32_t s = 0; s < p->r->s->signals; s++) {
        if (!peaks_of(p, s)) continue;
        if (classes_panel(p, k, s, err)) return -1;
        exceedance_panel(p, k++, s);
    }
    return 0;
}

/* --- all pictures --------------------------------------------------------------------------------------- */

/* The pictures of a table of its own; a page has all that the record can carry. */
static int plot_table(picture *p, int *made, fl_err *err)
{
    const struct options *o = p->o;
    const int cycles = o->page || o->table == TABLE_RAINFLOW || o->table == TABLE_DAMAGE;
    const int spectra = o->table == TABLE_SPECTRUM || o->table == TABLE_FREQUENCY ||
                        (o->page && p->r->s->n >= FL_SPECTRUM_SHORTEST_SEGMENT);
    const int sway = o->sways && (o->page || o->table == TABLE_RESPONSE || o->table == TABLE_MOTION);
    int varies = 0;
    for (int32_t s = 0; s < p->r->s->signals; s++) {
        const fl_signal_view *v = view_of(p->r, p->part, s, 0);
        varies += v && v->stats.max > v->stats.min;
    }
    const int levels = o->returns && (o->page || o->table == TABLE_LEVELS);
    p->what = "levels";
    const int drawn = levels ? plot_levels(p, made, err) : 0;
    if (drawn) return drawn;
    p->what = "rainflow";
    if (cycles && varies && plot_make(p, plot_rainflow, err)) return -1;
    p->what = "spectrum";
    if (spectra && varies && plot_make(p, plot_spectrum, err)) return -1;
    p->what = "response";
    if (sway && plot_make(p, plot_response, err)) return -1;
    *made += (cycles && varies) + (spectra && varies) + sway;
    return 0;
}

int plot(const struct result *r, const struct options *o, const fl_history_line *by, fl_err *err)
{
    const int32_t parts = r->s->parts, alone = parts == 2 && strcmp(r->s->part[1], "total") == 0;
    picture p = {.r = r, .o = o, .by = by};
    int made = 0;
    if (parts > PARTS_MAX)
        return fl_fail(err, FL_USAGE, "--plot draws at most %d parts, here are %d: choose one with --part",
                       PARTS_MAX, parts);
    if (mkdir(o->plot, 0777) != 0 && errno != EEXIST)
        return fl_fail(err, FL_SYSTEM, "%s: %s", o->plot, strerror(errno));
    for (p.part = alone; p.part < parts; p.part++) {
        int32_t n = 0, shown = 0;
        for (int32_t s = 0; s < r->s->signals; s++) {
            n += peaks_of(&p, s);
            shown += view_of(r, p.part, s, 0) != NULL;
        }
        if (!shown) continue;
        p.what = "history";
        if (plot_make(&p, history, err)) return -1;
        p.what = "peaks";
        if (n && plot_make(&p, peaks, err)) return -1;
        if (!n && !o->quiet) fprintf(stderr, "loadstats: %s has no peaks to draw\n", r->s->part[p.part]);
        made += 1 + (n > 0);
        if (plot_table(&p, &made, err)) return -1;
    }
    if (o->table == TABLE_LEGS || (o->page && !alone && parts > 2)) {
        if (plot_parts(r, o, by, err)) return -1;
        made++;
    }
    if (!o->quiet) fprintf(stderr, "loadstats: %d picture(s) in %s\n", made, o->plot);
    return 0;
}
