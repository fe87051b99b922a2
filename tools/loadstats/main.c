/* SPDX-License-Identifier: GPL-3.0-or-later */
/* loadstats -- from a load record to its statistics. */
#include <omp.h>
#include <stdlib.h>
#include "base/array.h"
#include "base/stream.h"
#include "base/output_guard.h"
#include "stat/resample.h"
#include "history_line.h"
#include "table_pressure.h"
#include "options.h"
#include "html_report.h"
#include "plot.h"
#include "table_stats.h"
#include "table_summary.h"

/* One view of one signal, if the signal exists for this part. */
static int make_one(fl_signal_view *v, const fl_series *s, const struct options *o, int each, int64_t k,
                    fl_err *err)
{
    const int32_t pair = (int32_t)(k / each), part = pair / s->signals, signal = pair % s->signals;
    const fl_signal_view_settings ask = {.filter = k % each ? o->filter : 0.0,
                                         .upper = o->upper,
                                         .kind = o->pass,
                                         .order = o->order,
                                         .ratio = o->separation,
                                         .threshold = o->threshold,
                                         .quantiles = o->quantiles,
                                         .p = o->quantile};
    if (!s->x[pair]) return 0;
    return fl_signal_view_make(v, s, part, signal, &ask, err);
}

/* Views are independent; the failure that is told is that of the first of them, whoever comes to it first. */
static int make_views(fl_signal_view *v, const fl_series *s, const struct options *o, int each, fl_err *err)
{
    const int64_t n = (int64_t)s->parts * s->signals * each;
    int64_t failed = n;
#pragma omp parallel for schedule(dynamic)
    for (int64_t k = 0; k < n; k++) {
        fl_err own = {0};
        if (make_one(&v[k], s, o, each, k, &own) == 0) continue;
#pragma omp critical
        if (k < failed) {
            failed = k;
            *err = own;
        }
    }
    return failed < n ? -1 : 0;
}

static void notes(const fl_series *s, const struct options *o)
{
    if (o->quiet) return;
    const double span = s->edge[s->n] - s->edge[0];
    if (o->verbose)
        fprintf(stderr, "loadstats: %d rows from %.10g s to %.10g s\n", s->n, s->edge[0], s->edge[s->n]);
    if (o->skips)
        fprintf(stderr, "loadstats: left out until %.10g s, by when the ice front has passed %g diameters\n",
                s->edge[0], o->skip[0]);
    if (o->filter > 0.0 && o->pass != FL_FILTER_MEAN && fl_resample_common_interval(s->n, s->edge) <= 0.0)
        fprintf(stderr,
                "loadstats: the intervals are not equal, the filter works on %d equal ones of %.10g s\n",
                s->n, span / s->n);
}

static int run(const struct options *o, fl_err *err)
{
    fl_series s = {0};
    fl_signal_view *views = NULL;
    fl_resampling_loss *loss = NULL;
    fl_out out = {0};
    fl_history_line by;
    const int each = o->filter > 0.0 ? 2 : 1;
    const fl_record_selection ask = {.signal = o->signal,
                                     .signals = o->signals,
                                     .part = o->part,
                                     .from = options_from(o),
                                     .to = o->to,
                                     .last = o->window,
                                     .after_first_load = options_after(o),
                                     .reduction = o->over,
                                     .where = o->where,
                                     .wheres = o->wheres};
    int rc = -1;
    int64_t n = 0;
    if (o->threads) omp_set_num_threads(o->threads);
    history_line_run(o, &by);
    if (fl_series_read(&s, o->in, &ask, err)) goto done;
    loss = fl_alloc((int64_t)s.parts * s.signals, sizeof *loss, err);
    if (!loss || (o->step > 0.0 && fl_resample_uniform(&s, o->step, loss, err))) goto done;
    n = (int64_t)s.parts * s.signals * each;
    views = fl_alloc(n, sizeof *views, err);
    if (!views || make_views(views, &s, o, each, err)) goto done;
    notes(&s, o);
    const struct result r = {&s, views, each, o->step > 0.0 ? loss : NULL};
    if (fl_out_open(&out, o->out, o->gzip, err) || table_write(out.f, &r, o, &by, err) ||
        fl_out_close(&out, err))
        goto done;
    if (o->plot && plot(&r, o, &by, err)) goto done;
    rc = o->report ? html_report_write_record(&r, o, err) : 0;
done:
    fl_out_abort(&out);
    for (int64_t k = 0; views && k < n; k++) fl_signal_view_free(&views[k]);
    free(views);
    free(loss);
    fl_series_free(&s);
    return rc;
}

static int check_targets(const struct options *o, fl_err *err)
{
    const fl_named_path out[] = {{"--output", o->out}, {"--report", o->report}};
    fl_named_path *in = fl_alloc(o->files, sizeof *in, err);
    if (!in) return -1;
    for (int k = 0; k < o->files; k++) in[k].path = o->file[k];
    const int rc = fl_output_guard_check(out, sizeof out / sizeof *out, in, (size_t)o->files, err);
    free(in);
    return rc;
}

int main(int argc, char **argv)
{
    struct options o;
    fl_err err = {0};
    fl_tool_begin();
    int rc = options_parse(&o, argc, argv, &err);
    if (rc == 0 && !o.ended) rc = check_targets(&o, &err);
    if (rc == 0 && !o.ended)
        rc = pressure_selected(&o)  ? pressure_run(&o, &err)
             : summary_selected(&o) ? summary_run(&o, &err)
                                    : run(&o, &err);
    options_free(&o);
    return fl_tool_end("loadstats", rc, &err);
}
