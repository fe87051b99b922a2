/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/extreme.h"
#include "stat/return_level.h"
#include "plot_levels.h"
#include "table_fits.h"

enum { POINTS = 60, BAND = 16 };

static const char *const COLOUR[FL_DISTS] = {"#08519c", "#3f8f5f", "#7b4fa3", "#c8642d", "#b8860b"};

/* A panel: the sample of a signal, the distributions fitted, the best of them by AIC, -1 for none. */
typedef struct {
    extreme_sample s;
    fl_dist law[FL_DISTS];
    int found[FL_DISTS], best;
    double from, to; /* periods [s] */
} panel;

static int open_panel(panel *q, const picture *p, int32_t s, fl_err *err)
{
    const fl_signal_view *v = find_view(p->r, p->part, s, 0);
    fl_fit_work w = {0};
    double least = INFINITY;
    *q = (panel){.best = -1};
    if (!v) return 0;
    if (extreme_sample_make(&q->s, v, p->o, err) || fl_fit_work_make(&w, q->s.n, err)) return -1;
    for (int kind = 0; kind < FL_DISTS && q->s.n > 0; kind++) {
        fl_dist *d = &q->law[kind];
        if (kind == FL_GPD && !q->s.excesses) continue;
        q->found[kind] = fl_fit(d, kind, FL_FIT_LIKELIHOOD, q->s.n, q->s.x, q->s.threshold, &w);
        const double aic =
            q->found[kind] ? fl_fit_aic(d, fl_fit_log_likelihood(d, q->s.n, q->s.x)) : INFINITY;
        if (!(aic < least)) continue;
        least = aic;
        q->best = kind;
    }
    fl_fit_work_free(&w);
    q->from = 1.05 / q->s.rate;
    q->to = (q->s.n + 1.0) / q->s.rate;
    for (int32_t k = 0; k < p->o->returns; k++) q->to = fmax(q->to, p->o->period[k]);
    return 0;
}

static double period_of(const panel *q, int k, int n)
{
    return q->from * pow(q->to / q->from, k / (n - 1.0));
}

static void write_point(const picture *p, int32_t s, int n, const double *x)
{
    plot_label(p, s, 0);
    plot_columns(p, n, x);
}

/* The interval of the best distribution; *top is raised to its largest upper end. */
static int make_band(const panel *q, fl_return_level r[BAND], double *top, fl_err *err)
{
    fl_fit_work w = {0};
    if (fl_fit_work_make(&w, q->s.n, err)) return -1;
    for (int k = 0; k < BAND; k++)
        r[k] = (fl_return_level){.tail = 1.0 / (q->s.rate * period_of(q, k, BAND))};
    const int rc =
        fl_compute_return_levels(&q->law[q->best], q->s.n, q->s.x, BAND, r, NULL, 0, 1, 0, &w, err);
    for (int k = 0; rc == 0 && k < BAND; k++) {
        for (int e = 0; e < 2; e++)
            if (!isfinite(r[k].profile[e])) r[k].profile[e] = r[k].level;
        *top = fmax(*top, r[k].profile[1]);
    }
    fl_fit_work_free(&w);
    return rc;
}

/* The largest unit of which a period holds two or more. */
static double unit_of_period(double period, const char **name)
{
    static const struct {
        const char *name;
        double seconds;
    } known[] = {{"a", 31557600.0}, {"d", 86400.0}, {"h", 3600.0}, {"min", 60.0}};
    for (size_t k = 0; k < sizeof known / sizeof *known; k++) {
        *name = known[k].name;
        if (period >= 2.0 * known[k].seconds) return known[k].seconds;
    }
    *name = "s";
    return 1.0;
}

/* The axis ends with the interval: a distribution of heavier tail would compress the rest.  Of values that
 * are not negative it starts at 0, though a distribution or its interval may go below. */
static int write_panel(picture *p, int k, int32_t s, const panel *q, fl_err *err)
{
    const plot_scale c = plot_scale_of_signal(p, s);
    const char *unit;
    const double second = 1.0 / unit_of_period(q->to, &unit);
    FILE *f = p->script;
    double top = q->s.x[0];
    fl_return_level r[BAND];
    char text[300];
    if (make_band(q, r, &top, err)) return -1;
    plot_set_margins(p, k, 0.095, 0.8);
    plot_signal_label(p, s, text, sizeof text);
    plot_left_title(p, text, 0.022);
    fprintf(f,
            "set logscale x\nset xrange [%.6g:%.6g]\nset yrange [%s:%.6g]\nset xlabel 'Return period  [%s]'\n"
            "set key outside right top vertical Left reverse\nset ytics autofreq\n",
            second * q->from, second * q->to, q->s.x[q->s.n - 1] < 0.0 ? "*" : "0", 1.05 * c.factor * top,
            unit);
    plot_curve(p);
    fprintf(f, "using (%g*$4):(%g*$5):(%g*$6) with filledcurves fc rgb '#dbe9f6' title '95 %% of %s'", second,
            c.factor, c.factor, fl_dist_name(q->best));
    plot_block(p);
    for (int i = 0; i < BAND; i++)
        write_point(p, s, 3, (double[]){period_of(q, i, BAND), r[i].profile[0], r[i].profile[1]});
    for (int kind = 0; kind < FL_DISTS; kind++) {
        if (!q->found[kind]) continue;
        plot_curve(p);
        fprintf(f, "using (%g*$4):(%g*$5) with lines lw %g lc rgb '%s' title '%s%s'", second, c.factor,
                kind == q->best ? 2.2 : 1.0, COLOUR[kind], fl_dist_name(kind),
                kind == q->best ? ", best" : "");
        plot_block(p);
        for (int i = 0; i < POINTS; i++) {
            const double T = period_of(q, i, POINTS);
            write_point(p, s, 2, (double[]){T, fl_dist_upper_quantile(&q->law[kind], 1.0 / (q->s.rate * T))});
        }
    }
    plot_curve(p);
    fprintf(f, "using (%g*$4):(%g*$5) with points pt 7 ps 0.5 lc rgb '#222222' title 'values'", second,
            c.factor);
    plot_block(p);
    for (int32_t i = 0; i < q->s.n; i++)
        write_point(p, s, 2, (double[]){1.0 / (q->s.rate * fl_plotting_position(i + 1, q->s.n)), q->s.x[i]});
    fprintf(f, "\nunset label 1\n");
    return 0;
}

static int fill_levels(picture *p, fl_err *err)
{
    int k = 0, rc = 0;
    p->gap = PLOT_FOOT + 10;
    p->panels = 0;
    for (int32_t s = 0; s < p->r->series->signals && rc == 0; s++) {
        panel q;
        rc = open_panel(&q, p, s, err);
        p->panels += rc == 0 && q.best >= 0;
        free(q.s.x);
    }
    fputs("signal\tunit\tview\tT[s]\tlevel_or_low\thigh\n", p->data);
    plot_start(p, "Return levels");
    for (int32_t s = 0; s < p->r->series->signals && rc == 0; s++) {
        panel q;
        rc = open_panel(&q, p, s, err);
        if (rc == 0 && q.best >= 0) rc = write_panel(p, k++, s, &q, err);
        free(q.s.x);
    }
    return rc;
}

/* A distribution can be fitted to one of the signals. */
static int has_fit(const picture *p, fl_err *err)
{
    for (int32_t s = 0; s < p->r->series->signals; s++) {
        panel q;
        const int rc = open_panel(&q, p, s, err), any = q.best >= 0;
        free(q.s.x);
        if (rc) return -1;
        if (any) return 1;
    }
    return 0;
}

const struct picture_kind levels_picture = {.name = "levels", .drawable = has_fit, .fill = fill_levels};
