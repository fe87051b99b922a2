/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "plot_regimes.h"
#include "table_regimes.h"

enum { STRETCHES = 3000 };

/* Of ice at rest beta has no meaning. */
#define BETA_MOST 3.0

static const char *const COLOUR[FL_REGIMES] = {"#6a51a3", "#c8642d", "#cb181d", "#2171b5"};

/* Points of the windows of each regime: what(window) over the middle of the window. */
static void write_points(picture *p, const struct regime_windows *q, double (*what)(const fl_regime_window *),
                         int keys)
{
    const double *edge = find_view(p->r, p->part, 0, 0)->edge;
    for (int regime = 0; regime < FL_REGIMES; regime++) {
        int32_t n = 0;
        for (int32_t k = 0; k < q->n; k++) n += q->window[k].regime == regime;
        if (n == 0) continue;
        plot_curve(p);
        fprintf(p->script, "using 4:5 with points pt 7 ps 0.6 lc rgb '%s' %s%s%s", COLOUR[regime],
                keys ? "title '" : "notitle", keys ? fl_regime_name(regime) : "", keys ? "'" : "");
        plot_block(p);
        for (int32_t k = 0; k < q->n; k++) {
            if (q->window[k].regime != regime) continue;
            plot_label(p, 0, 0);
            plot_columns(
                p, 2, (double[]){0.5 * (edge[k * q->each] + edge[(k + 1) * q->each]), what(&q->window[k])});
        }
    }
}

static double speed_of(const fl_regime_window *a) { return a->speed; }
static double beta_of(const fl_regime_window *a) { return a->beta; }
static double frequency_of(const fl_regime_window *a) { return a->frequency; }

/* The displacement, of each stretch its smallest and largest value [mm]. */
static void write_displacement(picture *p, const struct regime_windows *q)
{
    const fl_signal_view *v = find_view(p->r, p->part, 0, 0);
    const double *x = q->memory + q->rows;
    const int64_t m = q->rows > 2 * STRETCHES ? STRETCHES : q->rows;
    plot_curve(p);
    fputs("using 4:5 with lines lw 0.6 lc rgb '#555555' notitle", p->script);
    plot_block(p);
    for (int64_t j = 0; j < m; j++) {
        const int32_t from = (int32_t)(j * q->rows / m), to = (int32_t)((j + 1) * q->rows / m);
        int32_t lo = from, hi = from;
        for (int32_t i = from; i < to; i++) {
            if (x[i] < x[lo]) lo = i;
            if (x[i] > x[hi]) hi = i;
        }
        for (int end = 0; end < 2; end++) {
            const int32_t i = (lo < hi) == (end == 0) ? lo : hi;
            plot_label(p, 0, 0);
            plot_columns(p, 2, (double[]){v->edge[i + 1], 1e3 * x[i]});
        }
    }
}

static void begin_panel(picture *p, int k, const char *title, double low, double high)
{
    const double *edge = find_view(p->r, p->part, 0, 0)->edge;
    plot_set_margins(p, k, 0.095, 0.97);
    fprintf(p->script, "set xrange [%.10g:%.10g]\nset yrange [%.6g:%.6g]\nset ytics %.6g\n", edge[0],
            edge[find_view(p->r, p->part, 0, 0)->n], low, high, plot_tics(high - low));
    plot_left_title(p, title, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Time  [s]'\nset format x '%g'\n", p->script);
    else fputs("set format x ''\n", p->script);
}

/* Largest over the windows, with room for the key. */
static double top_of(const struct regime_windows *q, double (*what)(const fl_regime_window *))
{
    double most = 0.0;
    for (int32_t k = 0; k < q->n; k++)
        if (isfinite(what(&q->window[k]))) most = fmax(most, what(&q->window[k]));
    return most > 0.0 ? 1.2 * most : 1.0;
}

static void range_of_displacement(const struct regime_windows *q, double *low, double *high)
{
    const double *x = q->memory + q->rows;
    *low = INFINITY, *high = -INFINITY;
    for (int32_t k = 0; k < q->rows; k++) *low = fmin(*low, 1e3 * x[k]), *high = fmax(*high, 1e3 * x[k]);
    const double room = fmax(0.1 * (*high - *low), 1e-6 + 1e-3 * fabs(*high));
    *low -= room, *high += room;
}

static void write_panels(picture *p, const struct regime_windows *q)
{
    double low, high;
    begin_panel(p, 0, "Speed of the ice  [m/s]", 0.0, 1.15 * top_of(q, speed_of));
    fputs("set key inside top center horizontal maxrows 1 samplen 1\n", p->script);
    write_points(p, q, speed_of, 1);
    plot_end_panel(p);
    range_of_displacement(q, &low, &high);
    begin_panel(p, 1, "Displacement  [mm]", low, high);
    write_displacement(p, q);
    plot_end_panel(p);
    begin_panel(p, 2, "beta", 0.0, fmin(BETA_MOST, top_of(q, beta_of)));
    write_points(p, q, beta_of, 0);
    plot_end_panel(p);
    begin_panel(p, 3, "Frequency  [Hz]", 0.0, top_of(q, frequency_of));
    for (int32_t k = 0; k < p->o->modes; k++)
        fprintf(p->script,
                "set arrow %d from graph 0, first %.6g to graph 1, first %.6g nohead dt 2 lc rgb '#999999'\n",
                20 + (int)k, p->o->mode[k], p->o->mode[k]);
    write_points(p, q, frequency_of, 0);
    plot_end_panel(p);
}

static int fill_regimes(picture *p, fl_err *err)
{
    struct regime_windows q;
    const int rc = regimes_make(&q, p->r, p->o, p->part, err);
    if (rc == 0) {
        p->panels = 4;
        p->gap = 14;
        fputs("signal\tunit\tview\tt[s]\tvalue\n", p->data);
        plot_start(p, "Regimes of vibration");
        write_panels(p, &q);
    }
    regimes_free(&q);
    return rc;
}

static int can_draw_regimes(const picture *p, fl_err *err)
{
    (void)err;
    return p->r->series->signals >= 6 && find_view(p->r, p->part, 2, 0) != NULL;
}

const struct picture_kind regimes_picture = {
    .name = "regimes", .drawable = can_draw_regimes, .fill = fill_regimes};
