/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/array.h"
#include "stat/resample.h"
#include "table_spectrum.h"

int spectrum_make(fl_power_spectrum *s, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err)
{
    const fl_signal_view *v = find_view(r, part, signal, w);
    const double fs = v->n / (v->edge[v->n] - v->edge[0]), rows = o->segment * fs;
    const int even = fl_resample_common_interval(v->n, v->edge) > 0.0;
    fl_err own = {0};
    double *x = NULL;
    int32_t length = fl_spectrum_segment_length(v->n);
    if (o->segment > 0.0) length = rows < v->n + 0.5 ? (int32_t)(rows + 0.5) : INT32_MAX;
    if (length == INT32_MAX)
        return fl_fail(err, FL_INPUT, "--segment %g s is longer than the record of %g s", o->segment,
                       v->n / fs);
    if (!even) {
        x = fl_alloc(2 * (int64_t)v->n + 1, sizeof *x, err);
        if (!x) return -1;
        fl_resample_means(v->n, v->edge, v->x, v->n, x + v->n, x);
    }
    const int rc = fl_power_spectrum_make(s, v->n, even ? v->x : x, fs, length, o->taper, &own);
    free(x);
    if (rc)
        fl_fail(err, own.code, "%s of %s: %s", r->series->signal[signal], r->series->part[part], own.text);
    return rc;
}

static void write_first_cells(FILE *f, const struct record_views *r, int32_t part, int32_t signal, int w,
                              const fl_power_spectrum *s)
{
    write_labels(f, r, part, signal, w);
    fprintf(f, "\t%s", fl_taper_name(s->taper));
    write_cell(f, s->length / s->fs);
    fprintf(f, "\t%d", s->segments);
}

int spectrum_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err)
{
    fl_power_spectrum s;
    if (spectrum_make(&s, r, o, part, signal, w, err)) return -1;
    for (int32_t k = 0; k < s.n; k++) {
        double low, high;
        fl_power_spectrum_interval(&s, k, &low, &high);
        write_first_cells(f, r, part, signal, w, &s);
        write_cell(f, k * s.df);
        write_cell(f, s.psd[k]);
        write_cell(f, low);
        write_cell(f, high);
        putc('\n', f);
    }
    fl_power_spectrum_free(&s);
    return 0;
}

static void write_frequency_cells(FILE *f, const fl_signal_view *v, const struct options *o,
                                  const fl_power_spectrum *s)
{
    int32_t at;
    const double dominant = fl_power_spectrum_dominant(s, &at);
    write_cell(f, s->df);
    write_cell(f, s->enbw);
    write_cell(f, s->dof);
    write_cell(f, v->stats.std * v->stats.std);
    write_cell(f, fl_power_spectrum_variance(s));
    write_cell(f, dominant);
    write_cell(f, at < 0 ? NAN : s->psd[at]);
    write_cell(f, at < 0 ? NAN : fl_power_spectrum_share(s, at));
    write_cell(f, fl_power_spectrum_crossing_rate(s));
    write_cell(f, o->speed > 0.0 ? o->speed / dominant : NAN);
    putc('\n', f);
}

int frequency_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                   int32_t signal, int w, fl_err *err)
{
    fl_power_spectrum s;
    if (spectrum_make(&s, r, o, part, signal, w, err)) return -1;
    write_first_cells(f, r, part, signal, w, &s);
    write_frequency_cells(f, find_view(r, part, signal, w), o, &s);
    fl_power_spectrum_free(&s);
    return 0;
}
