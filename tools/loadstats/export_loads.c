/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "export_loads.h"
#include <stdio.h>
#include <string.h>
#include "base/number_text.h"
#include "base/stream.h"
#include "base/tool.h"
#include "stat/uniform_step.h"
#include "run_end.h"
#include "stat/series.h"

enum { LOADS = 6 };
static const char *const LOAD[LOADS] = {"fx", "fy", "fz", "mx", "my", "mz"};

/* Comments that tell how OpenFAST takes the file. */
static void write_head(FILE *f, const fl_series *s, const char *part, const fl_history_line *by)
{
    if (s->history) {
        for (const char *p = s->history, *end; (end = strchr(p, '\n')) != NULL; p = end + 1)
            fprintf(f, "%.*s\n", (int)(end - p), p);
    }
    fprintf(f, "%s\n", by->text);
    fprintf(f,
            "# Ice load on part %s for OpenFAST: PrescribedForcesFile of a structural control file with\n"
            "# StC_DOF_MODE = 4 and PrescribedForcesCoord = 1, at the reference point of the moments.\n"
            "# Time          FX            FY            FZ            MX            MY            MZ\n"
            "# (s)           (N)           (N)           (N)           (N-m)         (N-m)         (N-m)\n",
            part);
}

static void write_load_row(FILE *f, double t, const fl_series *s, int32_t part, int32_t k)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s", fl_number_text(t, text));
    for (int i = 0; i < LOADS; i++) fprintf(f, " %s", fl_number_text(s->x[part * s->signals + i][k], text));
    fputc('\n', f);
}

static void write_rows(FILE *f, const fl_series *s, int32_t part)
{
    write_load_row(f, s->edge[0], s, part, 0);
    for (int32_t k = 0; k < s->n; k++) write_load_row(f, 0.5 * (s->edge[k] + s->edge[k + 1]), s, part, k);
    write_load_row(f, s->edge[s->n], s, part, s->n - 1);
}

int export_loads(const struct options *o, fl_err *err)
{
    const fl_record_selection selection = {.signal = LOAD,
                                           .signals = LOADS,
                                           .part = o->part ? o->part : "total",
                                           .from = settings_from(o),
                                           .to = o->to,
                                           .last = o->window,
                                           .after_first_load = settings_after_first_load(o),
                                           .reduction = o->over,
                                           .where = o->where,
                                           .wheres = o->wheres};
    fl_series s = {0};
    fl_out out = {0};
    fl_history_line by;
    fl_resampling_loss loss[LOADS];
    char step[FL_NUMBER_LEN], text[RUN_END_NOTE];
    int rc = -1;
    if (fl_series_read(&s, o->in, &selection, err)) return -1;
    if (o->step > 0.0 && fl_resample_uniform(&s, o->step, loss, err)) goto done;
    fl_history_line_start(&by, "loadstats");
    fl_history_line_add(&by, "--export openfast");
    fl_history_line_word(&by, "--part ", s.part[0]);
    if (o->step > 0.0) fl_history_line_add(&by, "--step %s", fl_number_text(o->step, step));
    if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
    write_head(out.f, &s, s.part[0], &by);
    write_rows(out.f, &s, 0);
    rc = fl_out_close(&out, err);
    if (rc == 0 && s.end != FL_RUN_ENDED)
        fprintf(stderr, "loadstats: warning: %s: %s\n", strcmp(o->in, "-") ? o->in : "<stdin>",
                run_end_text(s.end, s.why, text));
    if (rc == 0 && !o->quiet)
        fprintf(stderr, "%d rows of part %s from %.10g s to %.10g s\n", s.n + 2, s.part[0], s.edge[0],
                s.edge[s.n]);
done:
    fl_out_abort(&out);
    fl_series_free(&s);
    return rc;
}
