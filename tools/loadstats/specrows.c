/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include "base/mem.h"
#include "stat/resample.h"
#include "specrows.h"

void specrows_header(FILE *f, const struct options *o)
{
    fputs("\twindow\tsegment[s]\tsegments", f);
    if (o->table == TABLE_SPECTRUM) fputs("\tf[Hz]\tpsd[unit^2/Hz]\tpsd_low\tpsd_high\n", f);
    else
        fputs("\tdf[Hz]\tenbw[Hz]\tdof\tvariance\tpower\tf[Hz]\tpsd[unit^2/Hz]\tshare\tcrossings[Hz]"
              "\tlength[m]\n",
              f);
}

int specrows_make(fl_welch *s, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                  int w, fl_err *err)
{
    const fl_view *v = view_of(r, part, signal, w);
    const double fs = v->n / (v->edge[v->n] - v->edge[0]), rows = o->segment * fs;
    const int even = fl_resample_step(v->n, v->edge) > 0.0;
    fl_err own = {0};
    double *x = NULL;
    int32_t length = fl_welch_length(v->n);
    if (o->segment > 0.0) length = rows < v->n + 0.5 ? (int32_t)(rows + 0.5) : INT32_MAX;
    if (length == INT32_MAX)
        return fl_fail(err, FL_INPUT, "--segment %g s is longer than the record of %g s", o->segment,
                       v->n / fs);
    if (!even) {
        x = fl_alloc(2 * (int64_t)v->n + 1, sizeof *x, err);
        if (!x) return -1;
        fl_resample_means(v->n, v->edge, v->x, v->n, x + v->n, x);
    }
    const int rc = fl_welch_make(s, v->n, even ? v->x : x, fs, length, o->taper, &own);
    free(x);
    if (rc) fl_fail(err, own.code, "%s of %s: %s", r->s->signal[signal], r->s->part[part], own.text);
    return rc;
}

static void put_start(FILE *f, const struct result *r, int32_t part, int32_t signal, int w, const fl_welch *s)
{
    put_label(f, r, part, signal, w);
    fprintf(f, "\t%s", fl_taper_name(s->taper));
    put_field(f, s->length / s->fs);
    fprintf(f, "\t%d", s->segments);
}

static void frequency_row(FILE *f, const fl_view *v, const struct options *o, const fl_welch *s)
{
    int32_t at;
    const double dominant = fl_welch_dominant(s, &at);
    put_field(f, s->df);
    put_field(f, s->enbw);
    put_field(f, s->dof);
    put_field(f, v->d.std * v->d.std);
    put_field(f, fl_welch_power(s));
    put_field(f, dominant);
    put_field(f, at < 0 ? NAN : s->psd[at]);
    put_field(f, at < 0 ? NAN : fl_welch_share(s, at));
    put_field(f, fl_welch_crossings(s));
    put_field(f, o->speed > 0.0 ? o->speed / dominant : NAN);
    putc('\n', f);
}

int specrows_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                   int w, fl_err *err)
{
    fl_welch s;
    if (specrows_make(&s, r, o, part, signal, w, err)) return -1;
    if (o->table == TABLE_FREQUENCY) {
        put_start(f, r, part, signal, w, &s);
        frequency_row(f, view_of(r, part, signal, w), o, &s);
    }
    for (int32_t k = 0; o->table == TABLE_SPECTRUM && k < s.n; k++) {
        double low, high;
        fl_welch_interval(&s, k, &low, &high);
        put_start(f, r, part, signal, w, &s);
        put_field(f, k * s.df);
        put_field(f, s.psd[k]);
        put_field(f, low);
        put_field(f, high);
        putc('\n', f);
    }
    fl_welch_free(&s);
    return 0;
}
