/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "plot_response.h"

/* Up to LINES oscillators are drawn against time; of more, their amplification against frequency. */
enum { LINES = 3, STRETCHES = 2000 };

/* Least relative range of an axis. */
static const double FLAT = 1e-6;

static void write_point(const picture *p, int32_t s, int w, double x, double y)
{
    plot_label(p, s, w);
    plot_columns(p, 2, (double[]){x, y});
}

/* A long record is reduced to the smallest and the largest value of each stretch. */
static void write_thinned(picture *p, int32_t s, const fl_signal_view *v, const double *y)
{
    const int64_t m = v->n > 2 * STRETCHES ? STRETCHES : v->n;
    plot_block(p);
    for (int64_t j = 0; j < m; j++) {
        const int32_t from = (int32_t)(j * v->n / m), to = (int32_t)((j + 1) * v->n / m);
        int32_t lo = from, hi = from;
        for (int32_t i = from; i < to; i++) {
            if (y[i] < y[lo]) lo = i;
            if (y[i] > y[hi]) hi = i;
        }
        write_point(p, s, 0, v->edge[(lo < hi ? lo : hi) + 1], y[lo < hi ? lo : hi]);
        if (lo != hi) write_point(p, s, 0, v->edge[(lo < hi ? hi : lo) + 1], y[lo < hi ? hi : lo]);
    }
}

static void extend_range(int32_t n, const double *y, double *lo, double *hi)
{
    for (int32_t k = 0; k < n; k++) {
        *lo = fmin(*lo, y[k]);
        *hi = fmax(*hi, y[k]);
    }
}

/* Load and responses against time. */
static int write_motion_panel(picture *p, int k, int32_t s, fl_err *err)
{
    static const char *const colour[LINES] = {"#08519c", "#c8642d", "#238b45"};
    const fl_signal_view *v = find_view(p->r, p->part, s, 0);
    const struct options *o = p->o;
    const plot_scale c = plot_scale_of_signal(p, s);
    double *y = fl_alloc((int64_t)v->n * LINES, sizeof *y, err), lo = v->stats.min, hi = v->stats.max;
    fl_oscillator_state *at = fl_alloc(v->n, sizeof *at, err);
    FILE *f = p->script;
    char text[300];
    int rc = y && at ? 0 : -1;
    for (int32_t i = 0; i < o->oscillators && rc == 0; i++) {
        fl_response got;
        double *to = y + (int64_t)i * v->n;
        rc = fl_oscillator_solve(&o->oscillator[i].o, v->n, v->edge, v->x, &got, at, err);
        for (int32_t j = 0; rc == 0 && j < v->n; j++) to[j] = at[j].u;
        if (rc == 0) extend_range(v->n, to, &lo, &hi);
    }
    if (rc) goto done;
    if (!(hi - lo > FLAT * fmax(fabs(lo), fabs(hi)))) { /* a constant */
        const double room = lo != 0.0 ? 0.5 * fabs(lo) : 1.0;
        lo -= room;
        hi += room;
    }
    plot_set_margins(p, k, 0.095, 0.97);
    fprintf(f, "set xrange [%.10g:%.10g]\nset yrange [%.10g:%.10g]\nset ytics %.6g\n", v->edge[0],
            v->edge[v->n], c.factor * (lo - 0.04 * (hi - lo)), c.factor * (hi + 0.04 * (hi - lo)),
            plot_tics(c.factor * (hi - lo)));
    plot_signal_label(p, s, text, sizeof text);
    plot_left_title(p, text, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Time  [s]'\nset format x '%g'\n", f);
    else fputs("set format x ''\n", f);
    for (int32_t i = 0; i < o->oscillators; i++) {
        plot_curve(p);
        fprintf(f, "using 4:($5*%g) with lines lw 1.4 lc rgb '%s' title '%g Hz, %g %%'", c.factor, colour[i],
                o->oscillator[i].o.frequency, 100.0 * o->oscillator[i].o.damping);
        write_thinned(p, s, v, y + (int64_t)i * v->n);
    }
    plot_curve(p); /* on top, because it is usually the smaller one */
    fprintf(f, "using 4:($5*%g) with lines ls 1 title 'load'", c.factor);
    write_thinned(p, s, v, v->x);
    plot_end_panel(p);
done:
    free(y);
    free(at);
    return rc;
}

/* Largest response over largest load against the natural frequency. */
static int write_amplification_panel(picture *p, int k, int32_t s, fl_err *err)
{
    const struct options *o = p->o;
    FILE *f = p->script;
    double low = INFINITY, high = 0.0;
    char text[120];
    for (int32_t i = 0; i < o->oscillators; i++) {
        low = fmin(low, o->oscillator[i].o.frequency);
        high = fmax(high, o->oscillator[i].o.frequency);
    }
    plot_set_margins(p, k, 0.095, 0.97);
    fprintf(f, "set logscale x\nset xrange [%.6g:%.6g]\nset yrange [0:*]\n", low / 1.1, high * 1.1);
    snprintf(text, sizeof text, "Amplification of %.80s", p->r->series->signal[s]);
    plot_left_title(p, text, 0.022);
    if (k + 1 == p->panels) fputs("set xlabel 'Natural frequency  [Hz]'\nset format x '%g'\n", f);
    else fputs("set format x ''\n", f);
    for (int w = 0; w < p->r->view_count; w++) {
        const fl_signal_view *v = find_view(p->r, p->part, s, w);
        const double load = fmax(fabs(v->stats.min), fabs(v->stats.max));
        plot_curve(p);
        fprintf(f, "using 4:5 smooth unique with linespoints ls %d title '%s'",
                p->r->view_count > 1 ? w + 1 : 3, view_name(w));
        plot_block(p);
        for (int32_t i = 0; i < o->oscillators; i++) {
            fl_response got;
            if (fl_oscillator_solve(&o->oscillator[i].o, v->n, v->edge, v->x, &got, NULL, err)) return -1;
            write_point(p, s, w, o->oscillator[i].o.frequency, load > 0.0 ? got.largest / load : 0.0);
        }
    }
    plot_end_panel(p);
    return 0;
}

static int fill_response(picture *p, fl_err *err)
{
    const int many = p->o->oscillators > LINES;
    int k = 0;
    p->gap = 26;
    for (int32_t s = 0; s < p->r->series->signals; s++) p->panels += find_view(p->r, p->part, s, 0) != NULL;
    fputs(many ? "signal\tunit\tview\tfn[Hz]\tamplification\n" : "signal\tunit\tview\tt[s]\tvalue\n",
          p->data);
    plot_start(p, many ? "Dynamic amplification" : "Response");
    for (int32_t s = 0; s < p->r->series->signals; s++) {
        if (!find_view(p->r, p->part, s, 0)) continue;
        if (many ? write_amplification_panel(p, k++, s, err) : write_motion_panel(p, k++, s, err)) return -1;
    }
    return 0;
}

const struct picture_kind response_picture = {.name = "response", .fill = fill_response};
