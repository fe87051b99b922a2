/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include "stat/event.h"
#include "comparison.h"
#include "table_parts.h"

/* A ratio; NAN for a zero or missing reference. */
static double ratio_of(double x, double of) { return of != 0.0 && isfinite(of) ? x / of : (double)NAN; }

int legs_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
              int w, fl_err *err)
{
    (void)err;
    const fl_signal_view *v = find_view(r, part, signal, w);
    const comparison c = compare_parts(r, signal, w);
    const fl_descriptive_stats *d = &v->stats;
    const int32_t n = v->peaks.n;
    const int loaded = d->max > 0.0, whole = part == c.total;
    const double level = o->level * d->max;
    double rise = 0.0, duration = 0.0;
    for (int32_t k = 0; k < n; k++) {
        const fl_event e = fl_event_of(v->n, v->y, v->edge, &v->peaks, k, o->level);
        rise += e.rise / n;
        duration += e.duration / n;
    }
    const double there = c.at >= 0 ? v->x[c.at] : (double)NAN;
    write_labels(f, r, part, signal, w);
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
    write_cell(f, whole ? NAN : ratio_of(d->mean, c.most_mean));
    write_cell(f, whole || !(c.most_max > 0.0) ? NAN : ratio_of(d->max, c.most_max));
    write_cell(f, there);
    write_cell(f, !loaded ? NAN : whole ? ratio_of(d->max, c.sum_max) : ratio_of(there, d->max));
    putc('\n', f);
    return 0;
}

int events_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err)
{
    (void)err;
    const fl_signal_view *v = find_view(r, part, signal, w);
    for (int32_t k = 0; k < v->peaks.n; k++) {
        const fl_event e = fl_event_of(v->n, v->y, v->edge, &v->peaks, k, o->level);
        write_labels(f, r, part, signal, w);
        write_cell(f, v->t[e.peak]);
        write_cell(f, v->y[e.peak]);
        write_cell(f, v->edge[e.first]);
        write_cell(f, v->edge[e.last + 1]);
        write_cell(f, e.rise);
        write_cell(f, e.fall);
        write_cell(f, e.duration);
        write_cell(f, e.impulse);
        putc('\n', f);
    }
    return 0;
}
