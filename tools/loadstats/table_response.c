/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "table_spectrum.h"
#include "table_response.h"

static void write_first_cells(FILE *f, const struct record_views *r, int32_t p, int32_t s, int w,
                              const struct oscillator_case *a)
{
    write_labels(f, r, p, s, w);
    write_cell(f, a->o.frequency);
    write_cell(f, a->o.damping);
}

static void write_motion(FILE *f, const struct record_views *r, int32_t p, int32_t s, int w,
                         const struct oscillator_case *a, const fl_oscillator_state *at)
{
    const fl_signal_view *v = find_view(r, p, s, w);
    for (int32_t k = 0; k < v->n; k++) {
        write_first_cells(f, r, p, s, w, a);
        write_cell(f, v->edge[k + 1]);
        write_cell(f, v->x[k]);
        write_cell(f, at[k].u);
        write_cell(f, at[k].u / a->stiffness);
        write_cell(f, at[k].v / a->stiffness);
        write_cell(f, at[k].a / a->stiffness);
        putc('\n', f);
    }
}

typedef struct {
    double frequency, share;
} dominant;

static int find_dominant(dominant *d, const struct record_views *r, const struct options *o, int32_t p,
                         int32_t s, int w, fl_err *err)
{
    fl_power_spectrum spectrum;
    int32_t at;
    *d = (dominant){NAN, NAN};
    if (!(o->segment > 0.0) && find_view(r, p, s, w)->n < FL_SPECTRUM_SHORTEST_SEGMENT)
        return 0; /* too short for a spectrum */
    if (spectrum_make(&spectrum, r, o, p, s, w, err)) return -1;
    d->frequency = fl_power_spectrum_dominant(&spectrum, &at);
    if (at >= 0) d->share = fl_power_spectrum_share(&spectrum, at);
    fl_power_spectrum_free(&spectrum);
    return 0;
}

static void write_response(FILE *f, const struct record_views *r, int32_t p, int32_t s, int w,
                           const struct oscillator_case *a, const fl_response *got, const dominant *d)
{
    const fl_signal_view *v = find_view(r, p, s, w);
    const double load = fmax(fabs(v->stats.min), fabs(v->stats.max));
    write_first_cells(f, r, p, s, w, a);
    write_cell(f, a->stiffness);
    write_cell(f, load);
    write_cell(f, got->largest);
    write_cell(f, got->largest / load);
    write_cell(f, got->t_largest);
    write_cell(f, got->std / v->stats.std);
    write_cell(f, load / a->stiffness);
    write_cell(f, got->largest / a->stiffness);
    write_cell(f, got->largest_acceleration / a->stiffness);
    write_cell(f, d->frequency);
    write_cell(f, d->share);
    fputs(isnan(d->frequency)                                 ? "\t-"
          : fl_oscillator_near_frequency(&a->o, d->frequency) ? "\tyes"
                                                              : "\tno",
          f);
    write_cell(f, got->step);
    write_cell(f, got->error);
    putc('\n', f);
}

/* The jumps of the load between rows excite an oscillator whose period is not much longer than a row. */
static void warn_long_rows(const struct record_views *r, const struct options *o)
{
    const double ROWS = 10.0; /* per period: the jumps of a sine are then a third of its amplitude */
    const fl_series *s = r->series;
    double longest = 0.0;
    for (int32_t k = 0; k < s->n; k++) longest = fmax(longest, s->edge[k + 1] - s->edge[k]);
    for (int32_t k = 0; !o->quiet && k < o->oscillators; k++)
        if (longest * o->oscillator[k].o.frequency * ROWS > 1.0 + 1e-9)
            fprintf(stderr,
                    "loadstats: rows of %.4g s are long for an oscillator of %.6g Hz, expected %g or more "
                    "per period\n",
                    longest, o->oscillator[k].o.frequency, ROWS);
}

int response_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    dominant d = {NAN, NAN};
    fl_oscillator_state *at = fl_alloc(v->n, sizeof *at, err);
    int rc = at ? 0 : -1;
    if (part == 0 && signal == 0 && w == 0) warn_long_rows(r, o);
    if (rc == 0) rc = find_dominant(&d, r, o, part, signal, w, err);
    for (int32_t k = 0; rc == 0 && k < o->oscillators; k++) {
        const struct oscillator_case *a = &o->oscillator[k];
        fl_response got;
        rc = fl_oscillator_solve(&a->o, v->n, v->edge, v->x, &got, at, err);
        if (rc == 0) write_response(f, r, part, signal, w, a, &got, &d);
    }
    free(at);
    return rc;
}

int motion_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    fl_oscillator_state *at = fl_alloc(v->n, sizeof *at, err);
    int rc = at ? 0 : -1;
    if (part == 0 && signal == 0 && w == 0) warn_long_rows(r, o);
    for (int32_t k = 0; rc == 0 && k < o->oscillators; k++) {
        const struct oscillator_case *a = &o->oscillator[k];
        fl_response got;
        rc = fl_oscillator_solve(&a->o, v->n, v->edge, v->x, &got, at, err);
        if (rc == 0) write_motion(f, r, part, signal, w, a, at);
    }
    free(at);
    return rc;
}
