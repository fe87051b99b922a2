/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include "base/array.h"
#include "base/stream.h"
#include "stat/run_summary.h"
#include "stat/summary_file.h"
#include "analyse_runs.h"
#include "history_line.h"
#include "html_report.h"
#include "run_end.h"
#include "start_up.h"
#include "table_kind.h"
#include "table_summary.h"

int runs_selected(const struct options *o)
{
    return o->table->source == FROM_RUNS || o->merge || o->stream || o->follow > 0.0;
}

/* --- table ---------------------------------------------------------------------------------------------- */

/* The table summary has no rows of entries: summary_file.h writes it, header included. */
static int is_summary(const struct options *o) { return o->table->run_rows == NULL; }

static void write_header(FILE *f, const char *history, const struct run_set *runs, const struct options *o)
{
    fl_history_line by;
    if (is_summary(o)) return;
    history_line_run(o, &by);
    fl_write_file_header(f, o->table->name, 1, history, &by);
    if (runs && runs->scene) fprintf(f, "# of the first run, %s\n", runs->scene);
    if (runs && runs->start && runs->start[0]) fprintf(f, "# %s\n", runs->start);
    table_write_columns(f, o);
}

static int write_rows(FILE *f, struct run_set *runs, const struct options *o, fl_err *err)
{
    if (is_summary(o)) return fl_summary_write(f, &runs->all, err);
    for (int32_t k = 0; k < runs->all.n; k++)
        if (o->table->run_rows(f, runs, k, o, err)) return -1;
    return 0;
}

/* --- reading -------------------------------------------------------------------------------------------- */

/* Print the rows of a growing record after every o->follow seconds of its data. */
static int write_progress(FILE *f, fl_run *run, const struct options *o, double *next, fl_err *err)
{
    if (run->end < *next) return 0;
    while (*next <= run->end) *next += o->follow;
    if (fl_run_update(run, err)) return -1;
    struct run_set now = {.all = run->sum};
    if (write_rows(f, &now, o, err)) return -1;
    return fflush(f) == 0 ? 0 : fl_fail(err, FL_SYSTEM, "%s: could not write all of it", o->out);
}

/* Keep the line that says which scene the run is, of the first run that has one. */
static int keep_scene(struct run_set *runs, const char *run_lines, fl_err *err)
{
    const char *at = run_lines && !runs->scene ? strstr(run_lines, "#report scene: ") : NULL;
    if (!at) return 0;
    runs->scene = fl_alloc_text(at + strlen("#report "), err);
    if (!runs->scene) return -1;
    runs->scene[strcspn(runs->scene, "\n")] = '\0';
    return 0;
}

static int read_run(struct run_set *runs, fl_summary *one, const char *path, FILE *f, const struct options *o,
                    const char *by, fl_err *err)
{
    const fl_record_selection selection = {.signal = o->signal,
                                           .signals = o->signals,
                                           .part = o->part,
                                           .about = o->abouts ? o->about : NULL,
                                           .from = settings_from(o),
                                           .to = o->to,
                                           .reduction = o->over,
                                           .where = o->where,
                                           .wheres = o->wheres,
                                           .patience = o->follow > 0.0 ? o->patience : 0.0};
    const fl_summary_settings settings = {.separation = o->separation,
                                          .threshold = o->threshold,
                                          .side = o->peaks,
                                          .block = o->block,
                                          .rule = o->rule,
                                          .residue = o->residue};
    fl_run run = {0};
    double next = NAN;
    int more, rc = -1;
    if (fl_run_open(&run, path, &selection, &settings, err)) goto done;
    while ((more = fl_run_next(&run, err)) > 0) {
        if (!(o->follow > 0.0)) continue;
        /* Rows are printed at whole multiples of the interval, for any start of the record. */
        if (isnan(next)) {
            write_header(f, fl_record_history(&run.record), NULL, o);
            next = o->follow * (floor(run.record.edge[0] / o->follow) + 1.0);
        }
        if (write_progress(f, &run, o, &next, err)) goto done;
    }
    if (more < 0 || fl_run_finish(&run, by, err)) goto done;
    if (!(o->follow > 0.0) && run_end_check(path, run.end_of_run, run.why, o, err)) goto done;
    rc = keep_scene(runs, fl_record_run_lines(&run.record), err) || fl_summary_merge(one, &run.sum, path, err)
             ? -1
             : 0;
done:
    fl_run_close(&run);
    return rc;
}

/* Values of the runs in ascending order, which does not depend on the order of the files. */
static void sort_values(fl_summary *all)
{
    for (int32_t k = 0; k < all->n; k++) {
        fl_multiset_sort(&all->entry[k].block);
        fl_multiset_sort(&all->entry[k].run[FL_RUN_MIN]), fl_multiset_sort(&all->entry[k].run[FL_RUN_MAX]);
    }
}

static int read_all(struct run_set *runs, FILE *f, const struct options *o, fl_err *err)
{
    char by[FL_HISTORY_LINE_MAX + 2] = "";
    /* The line that ends a chain is that of the summary; a table of one record has its own line only. */
    if (is_summary(o) || o->files > 1) history_line_summary(o, by);
    for (int k = 0; k < o->files; k++) {
        const char *path = o->file[k];
        fl_summary one = {0};
        int rc = o->merge ? fl_summary_read(&one, path, err) : read_run(runs, &one, path, f, o, by, err);
        if (rc == 0 && o->merge) rc = run_end_check_history(path, one.history, o, err);
        if (rc == 0) rc = fl_summary_merge(&runs->all, &one, path, err);
        if (rc == 0 && o->table->per_run) rc = ensemble_add(&runs->e, &runs->all, &one, path, err);
        fl_summary_free(&one);
        if (rc) return -1;
    }
    sort_values(&runs->all);
    return 0;
}

/* Two runs with one history are one run counted twice, which makes intervals too narrow. */
static void warn_repeated_runs(const fl_summary *all, const struct options *o)
{
    int64_t chains = 0, runs = 0;
    int other = 0; /* a line of another program */
    for (const char *p = all->history; p && *p; p = strchr(p, '\n') + 1) {
        const char *end = strchr(p, '\n'), *mark = strstr(p, " --summary");
        if (!end) break;
        if (mark && mark < end) chains++;
        else other = 1;
    }
    for (int32_t k = 0; k < all->n; k++) {
        const int64_t n = fl_multiset_size(&all->entry[k].run[FL_RUN_MEAN]);
        if (n > runs) runs = n;
    }
    if (!o->quiet && other && runs > chains && chains > 0)
        fprintf(stderr, "loadstats: %lld runs have %lld %s: some are the same run, counted twice\n",
                (long long)runs, (long long)chains, chains == 1 ? "history" : "histories");
}

/* --- report --------------------------------------------------------------------------------------------- */

static void write_intro(FILE *f, const void *what)
{
    const struct run_set *runs = *(struct run_set *const *)what;
    const fl_summary_signal *s = &runs->all.entry[0];
    fprintf(f,
            "%d runs of %lld rows and %.6g s in all, from %.6g s to %.6g s of a run. Every mean is the "
            "impulse divided by the time; the intervals of the estimates show the scatter between runs.",
            runs->e.runs, (long long)s->rows, fl_exact_value(&s->sum[0]), s->from, s->to);
    if (runs->scene) fprintf(f, " Of the first run, %s.", runs->scene);
    if (runs->start && runs->start[0]) fprintf(f, " The %s.", runs->start);
}

static int write_table(FILE *f, const void *what, const struct options *o, fl_err *err)
{
    struct run_set *runs = *(struct run_set *const *)what;
    write_header(f, runs->all.history, runs, o);
    return write_rows(f, runs, o, err);
}

static int draw_pictures(const void *what, const struct options *o, fl_err *err)
{
    fl_history_line by;
    history_line_run(o, &by);
    return o->table->draw_runs(*(struct run_set *const *)what, o, &by, err);
}

int analyse_runs(const struct options *given, fl_err *err)
{
    char start[START_NOTE];
    struct options used = *given;
    const struct options *const o = &used;
    struct run_set runs = {.start = start}, *const source = &runs;
    fl_out out = {0};
    int rc = -1;
    if (start_up_of_runs(given, &used.from, start, err)) return -1;
    if (start[0] && !o->quiet) fprintf(stderr, "loadstats: %s\n", start);
    /* With --follow rows are printed while the record is read; otherwise afterwards. */
    if (o->follow > 0.0 && fl_out_open(&out, o->out, o->gzip, err)) goto done;
    if (read_all(&runs, out.f, o, err)) goto done;
    warn_repeated_runs(&runs.all, o);
    if (!(o->follow > 0.0)) {
        if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
        write_header(out.f, runs.all.history, &runs, o);
    }
    if (write_rows(out.f, &runs, o, err)) goto done;
    if (fl_out_close(&out, err)) goto done;
    if (o->plot && draw_pictures(&source, o, err)) goto done;
    rc = 0;
    if (o->report) {
        const report_source from = {.what = &source,
                                    .many = 1,
                                    .title = "Ice loads of many runs",
                                    .history = runs.all.history,
                                    .span = runs.all.n ? fl_exact_value(&runs.all.entry[0].sum[0]) : 0.0,
                                    .intro = write_intro,
                                    .table = write_table,
                                    .draw = draw_pictures};
        rc = html_report_write(&from, o, err);
    }
done:
    fl_out_abort(&out);
    free(runs.e.x);
    free(runs.scene);
    fl_summary_free(&runs.all);
    return rc;
}
