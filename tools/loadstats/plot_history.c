/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "stat/extreme.h"
#include "stat/histogram.h"
#include "plot_history.h"

enum {
    GAP = 26,
    STRETCHES = 875,
    STRETCHES_OF_PAGE = 440,
    STRETCHES_OF_PART = 200,
    CLASSES = 20,
    ALL_RANKS = 200,
    ALL_RANKS_OF_PAGE = 40
};

/* Least relative range of an axis: a filtered constant varies by the rounding of its sums. */
static const double FLAT = 1e-6;

/* --- data ----------------------------------------------------------------------------------------------- */

static void write_history_row(const picture *p, int32_t s, int w, double t, double x)
{
    plot_label(p, s, w);
    plot_columns(p, 2, (double[]){t, x});
}

/* Stretches of a history.  A page has as many points as pixels, and fewer for each of several parts. */
static int64_t most_stretches(const picture *p)
{
    if (!p->o->report_page) return STRETCHES;
    return picture_of_sum(p) ? STRETCHES_OF_PAGE : STRETCHES_OF_PART;
}

/* A row of a loads table is the mean of an interval: drawn as a step in a short record, else at its
 * middle. */
static void write_history_block(picture *p, int32_t s, int w)
{
    const fl_signal_view *v = find_view(p->r, p->part, s, w);
    const int means = strcmp(p->r->series->kind, "loads") == 0,
              steps = means && w == 0 && v->n <= most_stretches(p);
    const int64_t stretches = v->n > 2 * most_stretches(p) ? most_stretches(p) : v->n;
    plot_block(p);
    for (int32_t k = 0; steps && k < v->n; k++) {
        write_history_row(p, s, w, v->edge[k], v->x[k]);
        write_history_row(p, s, w, v->edge[k + 1], v->x[k]);
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
            write_history_row(p, s, w, means ? 0.5 * (v->edge[row] + v->edge[row + 1]) : v->t[row],
                              v->x[row]);
        }
    }
}

/* All of the largest, then steps of a hundredth of the rank: the resolution of a picture. */
static int32_t next_rank(const picture *p, int32_t k)
{
    const int32_t all = p->o->report_page ? ALL_RANKS_OF_PAGE : ALL_RANKS;
    return k < all ? k + 1 : k + k / (all / 2);
}

static void write_exceedance_block(picture *p, int32_t s, int w)
{
    const fl_signal_view *v = find_view(p->r, p->part, s, w);
    const int32_t n = v->peaks.n;
    plot_block(p);
    for (int32_t k = 0; k < n; k = next_rank(p, k)) {
        plot_label(p, s, w);
        plot_columns(p, 3,
                     (double[]){v->peak_value[k], fl_plotting_position(k + 1, n),
                                v->t[v->peaks.row[v->peak_rank[k]]]});
    }
}

static void write_classes_block(picture *p, int32_t s, int w, const fl_histogram *h)
{
    plot_block(p);
    for (int32_t k = 0; k < h->n; k++) {
        plot_label(p, s, w);
        plot_columns(
            p, 3,
            (double[]){0.5 * (h->range[k] + h->range[k + 1]), h->bin[k], h->range[k + 1] - h->range[k]});
    }
}

static void write_history_panel(picture *p, int k, int32_t s)
{
    const struct record_views *r = p->r;
    const fl_signal_view *v = find_view(r, p->part, s, 0);
    const plot_scale c = plot_scale_of_signal(p, s);
    double lo = v->stats.min, hi = v->stats.max;
    char text[300];
    for (int w = 1; w < r->view_count; w++) {
        lo = fmin(lo, find_view(r, p->part, s, w)->stats.min);
        hi = fmax(hi, find_view(r, p->part, s, w)->stats.max);
    }
    if (!(hi - lo > FLAT * fmax(fabs(lo), fabs(hi)))) { /* a constant */
        const double room = lo != 0.0 ? 0.5 * fabs(lo) : 1.0;
        lo -= room;
        hi += room;
    }
    plot_set_margins(p, k, 0.095, 0.97);
    fprintf(p->script, "set xrange [%.10g:%.10g]\n", v->edge[0], v->edge[v->n]);
    fprintf(p->script, "set yrange [%.10g:%.10g]\nset ytics %.6g\n", c.factor * (lo - 0.04 * (hi - lo)),
            c.factor * (hi + 0.04 * (hi - lo)), plot_tics(c.factor * (hi - lo)));
    plot_signal_label(p, s, text, sizeof text);
    plot_left_title(p, text, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Time  [s]'\nset format x '%g'\n", p->script);
    else fputs("set format x ''\n", p->script);
    for (int w = 0; w < r->view_count; w++) {
        plot_curve(p);
        fprintf(p->script, "using 4:($5*%g) with lines ls %d title '%s", c.factor,
                r->view_count > 1 ? w + 1 : 3, view_name(w));
        if (w) {
            settings_filter_text(p->o, text, sizeof text);
            fprintf(p->script, ", %s'", text);
        }
        if (!w) putc('\'', p->script);
        write_history_block(p, s, w);
    }
    plot_end_panel(p);
}

static int fill_history(picture *p, fl_err *err)
{
    int k = 0;
    (void)err;
    p->gap = GAP;
    for (int32_t s = 0; s < p->r->series->signals; s++) p->panels += find_view(p->r, p->part, s, 0) != NULL;
    fputs("signal\tunit\tview\tt[s]\tvalue\n", p->data);
    plot_start(p, plot_is_loads(p) ? "Load history" : "History");
    for (int32_t s = 0; s < p->r->series->signals; s++)
        if (find_view(p->r, p->part, s, 0)) write_history_panel(p, k++, s);
    return 0;
}

/* Number of peaks of a signal in all its views. */
static int32_t count_peaks(const picture *p, int32_t s)
{
    int32_t n = 0;
    for (int w = 0; find_view(p->r, p->part, s, 0) && w < p->r->view_count; w++)
        n += find_view(p->r, p->part, s, w)->peaks.n;
    return n;
}

/* Left panel: the number of peaks in each class; both views share the classes. */
static int write_classes_panel(picture *p, int k, int32_t s, fl_err *err)
{
    const struct record_views *r = p->r;
    const plot_scale c = plot_scale_of_signal(p, s);
    fl_histogram h[2] = {{0}, {0}};
    double lo = INFINITY, hi = -INFINITY, most = 0.0;
    char text[300];
    int rc = -1;
    for (int w = 0; w < r->view_count; w++) {
        const fl_signal_view *v = find_view(r, p->part, s, w);
        if (!v->peaks.n) continue;
        hi = fmax(hi, v->peak_value[0]);
        lo = fmin(lo, v->peak_value[v->peaks.n - 1]);
    }
    for (int w = 0; w < r->view_count; w++) {
        const fl_signal_view *v = find_view(r, p->part, s, w);
        if (fl_histogram_make(&h[w], CLASSES, lo, hi, err)) goto done;
        for (int32_t i = 0; i < v->peaks.n; i++) fl_histogram_add(&h[w], v->peak_value[i], 1.0);
        for (int32_t i = 0; i < CLASSES; i++) most = fmax(most, h[w].bin[i]);
    }
    plot_set_margins(p, k, 0.1, 0.475);
    plot_signal_label(p, s, text, sizeof text);
    fputs("set xlabel ", p->script);
    plot_quoted(p->script, text);
    putc('\n', p->script);
    fprintf(p->script, "set xtics %.6g\n", plot_tics(c.factor * (h[0].range[CLASSES] - h[0].range[0])));
    plot_left_title(p, "Peaks in class", 0.018);
    fprintf(p->script, "unset logscale y\nset yrange [0:%g]\nset ytics %g\n", 1.08 * most,
            fmax(1.0, plot_tics(most)));
    for (int w = 0; w < r->view_count; w++) {
        plot_curve(p);
        fprintf(p->script,
                "using ($4*%g):5:($6*%g) with boxes fill solid 1.0 noborder lc rgb '%s' title '%s'", c.factor,
                c.factor * (w ? 0.45 : 0.92), r->view_count > 1 ? (w ? "#08519c" : "#9ecae1") : "#2171b5",
                view_name(w));
        write_classes_block(p, s, w, &h[w]);
    }
    plot_end_panel(p);
    rc = 0;
done:
    fl_histogram_free(&h[0]);
    fl_histogram_free(&h[1]);
    return rc;
}

/* Right panel: the probability that a peak is larger. */
static void write_exceedance_panel(picture *p, int k, int32_t s)
{
    const plot_scale c = plot_scale_of_signal(p, s);
    plot_set_margins(p, k, 0.58, 0.97);
    plot_left_title(p, "Probability of exceedance", 0.508);
    double lo = INFINITY, hi = -INFINITY;
    for (int w = 0; w < p->r->view_count; w++) {
        const fl_signal_view *v = find_view(p->r, p->part, s, w);
        if (!v->peaks.n) continue;
        hi = fmax(hi, v->peak_value[0]);
        lo = fmin(lo, v->peak_value[v->peaks.n - 1]);
    }
    fprintf(p->script, "set xtics %.6g\n", plot_tics(c.factor * (hi > lo ? hi - lo : fabs(hi))));
    fputs("set logscale y\nset yrange [*:1]\nset ytics autofreq\nset format y '%g'\n", p->script);
    for (int w = 0; w < p->r->view_count; w++) {
        if (!find_view(p->r, p->part, s, w)->peaks.n) continue;
        plot_curve(p);
        fprintf(p->script, "using ($4*%g):5 with points ls %d title '%s'", c.factor,
                p->r->view_count > 1 ? w + 1 : 3, view_name(w));
        write_exceedance_block(p, s, w);
    }
    plot_end_panel(p);
}

static int fill_peaks(picture *p, fl_err *err)
{
    int k = 0;
    p->gap = PLOT_FOOT + 10;
    for (int32_t s = 0; s < p->r->series->signals; s++) p->panels += count_peaks(p, s) > 0;
    fputs("signal\tunit\tview\tpeak\tcount_or_P\twidth_or_t\n", p->data);
    plot_start(p, plot_is_loads(p) ? "Load peaks" : "Peaks");
    for (int32_t s = 0; s < p->r->series->signals; s++) {
        if (!count_peaks(p, s)) continue;
        if (write_classes_panel(p, k, s, err)) return -1;
        write_exceedance_panel(p, k++, s);
    }
    return 0;
}

static int has_peaks(const picture *p, fl_err *err)
{
    int32_t n = 0;
    (void)err;
    for (int32_t s = 0; s < p->r->series->signals; s++) n += count_peaks(p, s);
    return n > 0;
}

const struct picture_kind history_picture = {.name = "history", .fill = fill_history};
const struct picture_kind peaks_picture = {.name = "peaks", .drawable = has_peaks, .fill = fill_peaks};
