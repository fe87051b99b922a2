/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/stream.h"
#include "stat/power_spectrum.h"
#include "stat/resample.h"
#include "stat/stationary.h"
#include "analyse_record.h"
#include "history_line.h"
#include "html_report.h"
#include "plot.h"
#include "run_end.h"
#include "start_up.h"
#include "table_kind.h"

/* --- views ---------------------------------------------------------------------------------------------- */

/* One view of a signal, where the signal exists for the part. */
static int make_view(fl_signal_view *v, const fl_series *s, const struct options *o, int each, int64_t k,
                     fl_err *err)
{
    const int32_t pair = (int32_t)(k / each), part = pair / s->signals, signal = pair % s->signals;
    const fl_signal_view_settings settings = {.filter = k % each ? o->filter : 0.0,
                                              .upper = o->upper,
                                              .kind = o->filter_kind,
                                              .order = o->order,
                                              .ratio = o->separation,
                                              .threshold = o->threshold,
                                              .side = o->peaks,
                                              .quantiles = o->quantiles,
                                              .p = o->quantile};
    if (!s->x[pair]) return 0;
    return fl_signal_view_make(v, s, part, signal, &settings, err);
}

/* Views are independent.  The reported failure is that of the first view, for any order of the threads. */
static int make_views(fl_signal_view *v, const fl_series *s, const struct options *o, int each, fl_err *err)
{
    const int64_t n = (int64_t)s->parts * s->signals * each;
    int64_t failed = n;
#pragma omp parallel for schedule(dynamic)
    for (int64_t k = 0; k < n; k++) {
        fl_err own = {0};
        if (make_view(&v[k], s, o, each, k, &own) == 0) continue;
#pragma omp critical
        if (k < failed) {
            failed = k;
            *err = own;
        }
    }
    return failed < n ? -1 : 0;
}

/* --- noise ---------------------------------------------------------------------------------------------- */

/* A signal whose root mean square is below this share of the largest of its unit is rounding: the vertical
 * force on a vertical wall. */
static const double NOISE = 1e-9;

static double root_mean_square(const fl_signal_view *v) { return hypot(v->stats.mean, v->stats.std); }

/* Leave out signals that are rounding beside the others of their unit.  A signal that is 0 is a result. */
static void drop_noise(fl_signal_view *v, const fl_series *s, int each, unsigned char *dropped)
{
    for (int32_t k = 0; k < s->parts * s->signals; k++) {
        double most = 0.0;
        for (int32_t j = 0; j < s->parts * s->signals; j++)
            if (strcmp(s->unit[j % s->signals], s->unit[k % s->signals]) == 0 && v[j * each].n)
                most = fmax(most, root_mean_square(&v[j * each]));
        const double own = v[k * each].n ? root_mean_square(&v[k * each]) : 0.0;
        dropped[k] = own > 0.0 && own < NOISE * most;
    }
    for (int32_t k = 0; k < s->parts * s->signals; k++)
        for (int w = 0; dropped[k] && w < each; w++) fl_signal_view_free(&v[k * each + w]);
}

static void print_dropped(FILE *f, const fl_series *s, const unsigned char *dropped, const char *before)
{
    for (int32_t k = 0; dropped && k < s->parts * s->signals; k++)
        if (dropped[k])
            fprintf(f, "%s%s of %s is left out: below %g of the largest of its unit, rms, it is rounding\n",
                    before, s->signal[k % s->signals], s->part[k / s->signals], NOISE);
}

static void print_notes(const fl_series *s, const struct options *o)
{
    char text[RUN_END_NOTE];
    if (s->end != FL_RUN_ENDED)
        fprintf(stderr, "loadstats: warning: %s: %s\n", strcmp(o->in, "-") ? o->in : "<stdin>",
                run_end_text(s->end, s->why, text));
    if (o->quiet) return;
    const double span = s->edge[s->n] - s->edge[0];
    if (o->verbose)
        fprintf(stderr, "loadstats: %d rows from %.10g s to %.10g s\n", s->n, s->edge[0], s->edge[s->n]);
    if (o->skips)
        fprintf(stderr, "loadstats: dropped until %.10g s, when the ice front has passed %g diameters\n",
                s->edge[0], o->skip[0]);
    if (o->filter > 0.0 && o->filter_kind != FL_FILTER_MEAN &&
        fl_resample_common_interval(s->n, s->edge) <= 0.0)
        fprintf(stderr,
                "loadstats: the intervals are not equal, the filter works on %d equal ones of %.10g s\n",
                s->n, span / s->n);
}

/* Peaks of the maxima say nothing of a load that acts the other way. */
static const double OTHER_WAY = 10.0;

static void warn_side(const struct record_views *r, const struct options *o)
{
    const int of_peaks = (o->table->uses & USES_SAMPLE) != 0 && strcmp(o->table->name, "overview") != 0;
    for (int32_t k = 0; of_peaks && !o->peaks && k < r->series->parts * r->series->signals; k++) {
        const fl_signal_view *v = find_view(r, k / r->series->signals, k % r->series->signals, 0);
        if (!v || !(-v->stats.min > OTHER_WAY * v->stats.max)) continue;
        fprintf(stderr,
                "loadstats: %s of %s acts along its negative axis, from %.6g to %.6g: its peaks are those of "
                "--peaks min or abs, not of max%s\n",
                r->series->signal[k % r->series->signals], r->series->part[k / r->series->signals],
                v->stats.min, v->stats.max,
                r->series->has_motion ? "; of a hull under way, -C resistance is positive" : "");
    }
}

/* The signal that a designer reads first: the largest force by root mean square, of the total where there is
 * one. */
static const fl_signal_view *find_main_force(const struct record_views *r, int32_t *part, int32_t *signal)
{
    const fl_series *s = r->series;
    const fl_signal_view *most = NULL;
    for (int32_t p = 0; p < s->parts; p++)
        for (int32_t k = 0; k < s->signals; k++) {
            const fl_signal_view *v = find_view(r, p, k, 0);
            if (!v || strcmp(s->unit[k], "N") != 0) continue;
            if (most && root_mean_square(v) < root_mean_square(most)) continue;
            most = v, *part = p, *signal = k;
        }
    return most;
}

/* A mean of a record that drifts is one of the length of the run. */
static int warn_moving_mean(const struct record_views *r, fl_err *err)
{
    int32_t p = 0, k = 0;
    fl_stationarity s;
    const fl_signal_view *v = strcmp(r->series->kind, "loads") == 0 ? find_main_force(r, &p, &k) : NULL;
    if (!v) return 0;
    if (fl_stationarity_make(&s, v->n, v->x, v->edge[v->n] - v->edge[0], err)) return -1;
    if (s.moves)
        fprintf(
            stderr,
            "loadstats: warning: %s of %s is not stationary: mean %.3g kN in the first half and %.3g kN in "
            "the second, %.2g standard errors apart, its blocks with a trend of %.2g: --from where it "
            "settles is "
            "expected, or, where it does not, a result for this length of run only, see ice-scenes(7)\n",
            r->series->signal[k], r->series->part[p], 1e-3 * s.mean[0], 1e-3 * s.mean[1], fabs(s.apart),
            fabs(s.trend));
    return 0;
}

/* Repeat what the run says of a jam, whose loads are those of its bounds, also where they look stationary. */
static void warn_jam(const fl_series *s)
{
    static const char *const JAM[] = {"#report warning: the field is too narrow",
                                      "#report warning: a jam has met the inflow"};
    for (size_t k = 0; s->run_lines && k < sizeof JAM / sizeof *JAM; k++) {
        const char *at = strstr(s->run_lines, JAM[k]);
        if (!at) continue;
        at += strlen("#report warning: ");
        fprintf(stderr, "loadstats: warning: the run says: %.*s\n", (int)strcspn(at, ";\n"), at);
    }
}

/* --- table, pictures, report ---------------------------------------------------------------------------- */

/* Which scene of ice-scenes(7) the run is, as its report says, and the length of that line; NULL: it does not
 * say. */
static const char *scene_of_run(const fl_series *s, int *len)
{
    const char *at = s->run_lines ? strstr(s->run_lines, "#report scene: ") : NULL;
    if (!at) return NULL;
    at += strlen("#report ");
    *len = (int)strcspn(at, "\n");
    return at;
}

static void write_intro(FILE *f, const void *what)
{
    const struct record_views *r = what;
    const fl_series *s = r->series;
    double share = 0.0;
    int len = 0;
    const char *scene = scene_of_run(s, &len);
    if (scene) fprintf(f, "The %.*s. ", len, scene);
    fprintf(f, "%d rows of the %s table, from %.6g s to %.6g s.", s->n, s->kind, s->edge[0], s->edge[s->n]);
    if (r->start && r->start[0]) fprintf(f, " The %s.", r->start);
    if (strcmp(s->kind, "loads") == 0)
        fputs(" A row is the mean over its interval; every mean is the impulse divided by the time.", f);
    for (int64_t k = 0; r->loss && k < (int64_t)s->parts * s->signals; k++) {
        const fl_signal_view *v = &r->views[k * r->view_count];
        if (v->n && v->stats.std > 0.0)
            share = fmax(share, r->loss[k].rms / hypot(r->loss[k].rms, v->stats.std));
    }
    if (r->loss)
        fprintf(
            f,
            " The record was resampled to equal steps, which removes up to %.3g %% of a standard deviation.",
            100.0 * share);
    if (r->view_count > 1)
        fputs(" The raw view is shown beside the filtered one, because a filter hides spikes.", f);
}

/* The loss of --step stands above the column names. */
static void write_loss(FILE *f, const struct record_views *r, const struct options *o)
{
    for (int32_t p = 0; r->loss && p < r->series->parts; p++) {
        for (int32_t s = 0; s < r->series->signals; s++) {
            const fl_resampling_loss *l = &r->loss[(int64_t)p * r->series->signals + s];
            if (!find_view(r, p, s, 0)) continue;
            fprintf(f, "# steps of %g s: %s of %s loses %.6g rms, %.6g at most\n", o->step,
                    r->series->signal[s], r->series->part[p], l->rms, l->largest);
        }
    }
}

static int write_table(FILE *f, const void *what, const struct options *o, fl_err *err)
{
    const struct record_views *r = what;
    const struct table *t = o->table;
    const int32_t parts = r->series->parts, signals = r->series->signals;
    int len = 0;
    fl_history_line by;
    history_line_run(o, &by);
    fl_write_file_header(f, t->name, 1, r->series->history, &by);
    const char *scene = scene_of_run(r->series, &len);
    if (scene) fprintf(f, "# %.*s\n", len, scene);
    if (r->start && r->start[0]) fprintf(f, "# %s\n", r->start);
    write_loss(f, r, o);
    print_dropped(f, r->series, r->dropped, "# ");
    table_write_columns(f, o);
    for (int32_t k = 0; k < parts * signals; k++) {
        const int32_t p = t->by_signal ? k % parts : k / signals, s = t->by_signal ? k / parts : k % signals;
        if (!find_view(r, p, s, 0)) continue;
        if (t->signal_rows && t->signal_rows(f, r, o, p, s, err)) return -1;
        for (int w = 0; t->view_rows && w < r->view_count; w++)
            if (t->view_rows(f, r, o, p, s, w, err)) return -1;
    }
    return 0;
}

static int draw_pictures(const void *what, const struct options *o, fl_err *err)
{
    fl_history_line by;
    history_line_run(o, &by);
    return plot_record(what, o, &by, err);
}

static int write_report(const struct record_views *r, const struct options *o, fl_err *err)
{
    const fl_series *s = r->series;
    const report_source from = {.what = r,
                                .title = strcmp(s->kind, "loads") == 0 ? "Ice loads" : "Statistics",
                                .history = s->history,
                                .run_lines = s->run_lines,
                                .legs = s->parts > 2,
                                .spectra = s->n >= FL_SPECTRUM_SHORTEST_SEGMENT,
                                .span = s->edge[s->n] - s->edge[0],
                                .intro = write_intro,
                                .table = write_table,
                                .draw = draw_pictures};
    return html_report_write(&from, o, err);
}

int analyse_record(const struct options *o, fl_err *err)
{
    fl_series s = {0};
    fl_signal_view *views = NULL;
    fl_resampling_loss *loss = NULL;
    unsigned char *dropped = NULL;
    char start[START_NOTE] = "";
    fl_out out = {0};
    const int each = o->filter > 0.0 ? 2 : 1;
    const fl_record_selection selection = {.signal = o->signal,
                                           .signals = o->signals,
                                           .part = o->part,
                                           .about = o->abouts ? o->about : NULL,
                                           .from = settings_from(o),
                                           .to = o->to,
                                           .last = o->window,
                                           .after_first_load = settings_after_first_load(o),
                                           .reduction = o->over,
                                           .where = o->where,
                                           .wheres = o->wheres};
    int rc = -1;
    int64_t n = 0;
    if (o->threads) omp_set_num_threads(o->threads);
    if (fl_series_read(&s, o->in, &selection, err) || start_up_drop(&s, o, start, err)) goto done;
    if (start[0] && !o->quiet) fprintf(stderr, "loadstats: %s\n", start);
    loss = fl_alloc((int64_t)s.parts * s.signals, sizeof *loss, err);
    if (!loss || (o->step > 0.0 && fl_resample_uniform(&s, o->step, loss, err))) goto done;
    n = (int64_t)s.parts * s.signals * each;
    views = fl_alloc(n, sizeof *views, err);
    dropped = fl_alloc((int64_t)s.parts * s.signals, 1, err);
    if (!views || !dropped || make_views(views, &s, o, each, err)) goto done;
    drop_noise(views, &s, each, dropped);
    print_notes(&s, o);
    if (!o->quiet) print_dropped(stderr, &s, dropped, "loadstats: ");
    const struct record_views r = {&s, views, each, o->step > 0.0 ? loss : NULL, dropped, start};
    if (!o->quiet) {
        warn_side(&r, o);
        warn_jam(&s);
        if (warn_moving_mean(&r, err)) goto done;
    }
    if (fl_out_open(&out, o->out, o->gzip, err) || write_table(out.f, &r, o, err) || fl_out_close(&out, err))
        goto done;
    if (o->plot && draw_pictures(&r, o, err)) goto done;
    rc = o->report ? write_report(&r, o, err) : 0;
done:
    fl_out_abort(&out);
    for (int64_t k = 0; views && k < n; k++) fl_signal_view_free(&views[k]);
    free(views);
    free(loss);
    free(dropped);
    fl_series_free(&s);
    return rc;
}
