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

/* A form of the file: comment sign, head, row. */
struct export_form {
    const char *name, *comment;
    double scale; /* of loads */
    void (*head)(FILE *f, const fl_series *s, const char *part);
    void (*row)(FILE *f, const char *part, int32_t k, double t, const double load[LOADS]);
    void (*end)(FILE *f, const char *part);
    int32_t most; /* rows; 0: any number */
};

/* The histories of the inputs, as comments of the form. */
static void write_history(FILE *f, const struct export_form *form, const fl_series *s, const char *by)
{
    for (const char *p = s->history, *end; p && (end = strchr(p, '\n')) != NULL; p = end + 1)
        fprintf(f, "%s%.*s\n", form->comment, (int)(end - p), p);
    fprintf(f, "%s%s\n", form->comment, by);
}

static void write_separated(FILE *f, double t, const double load[LOADS], char between)
{
    char text[FL_NUMBER_LEN];
    fprintf(f, "%s", fl_number_text(t, text));
    for (int i = 0; i < LOADS; i++) fprintf(f, "%c%s", between, fl_number_text(load[i], text));
    fputc('\n', f);
}

/* --- OpenFAST: comments that tell how it takes the file ------------------------------------------------- */

static void write_openfast_head(FILE *f, const fl_series *s, const char *part)
{
    (void)s;
    fprintf(f,
            "# Ice load on part %s for OpenFAST: PrescribedForcesFile of a structural control file with\n"
            "# StC_DOF_MODE = 4 and PrescribedForcesCoord = 1, at the reference point of the moments.\n"
            "# Time          FX            FY            FZ            MX            MY            MZ\n"
            "# (s)           (N)           (N)           (N)           (N-m)         (N-m)         (N-m)\n",
            part);
}

static void write_openfast_row(FILE *f, const char *part, int32_t k, double t, const double load[LOADS])
{
    (void)part, (void)k;
    write_separated(f, t, load, ' ');
}

/* --- OrcaFlex: names in the first row, tabs, kN and kN.m, no comments ----------------------------------- */

static void write_orcaflex_head(FILE *f, const fl_series *s, const char *part)
{
    (void)s, (void)part;
    fputs("Time (s)\tFx (kN)\tFy (kN)\tFz (kN)\tMx (kN.m)\tMy (kN.m)\tMz (kN.m)\n", f);
}

static void write_orcaflex_row(FILE *f, const char *part, int32_t k, double t, const double load[LOADS])
{
    (void)part, (void)k;
    write_separated(f, t, load, '\t');
}

/* --- ANSYS: tables of APDL over time -------------------------------------------------------------------- */

static void write_ansys_head(FILE *f, const fl_series *s, const char *part)
{
    fprintf(
        f,
        "! Ice load on part %s, N and N.m, at the reference point of the moments: /INPUT this file, then for "
        "a node\n",
        part);
    for (int i = 0; i < LOADS; i++) fprintf(f, "*DIM,ICE_%s,TABLE,%d,,,TIME\n", LOAD[i], s->n + 2);
}

static void write_ansys_row(FILE *f, const char *part, int32_t k, double t, const double load[LOADS])
{
    (void)part;
    char text[FL_NUMBER_LEN], time[FL_NUMBER_LEN];
    fl_number_text(t, time);
    for (int i = 0; i < LOADS; i++)
        fprintf(f, "ICE_%s(%d,0)=%s $ICE_%s(%d)=%s\n", LOAD[i], k + 1, time, LOAD[i], k + 1,
                fl_number_text(load[i], text));
}

static void write_ansys_end(FILE *f, const char *part)
{
    (void)part;
    for (int i = 0; i < LOADS; i++)
        fprintf(f, "! F,NODE,%c%c,%%ICE_%s%%\n", i < 3 ? 'F' : 'M', 'X' + i % 3, LOAD[i]);
}

/* --- SACS: a load condition with a load on a joint for each time --------------------------------------- */

/* The conditions are numbered, in four columns. */
enum { SACS_MOST = 9999, SACS_WIDTH = 7 };

/* A number in seven columns, with as many decimals as fit, up to three. */
static void write_sacs_number(FILE *f, double x)
{
    char text[FL_NUMBER_LEN * 12];
    for (int decimals = 3; decimals >= 0; decimals--)
        if (snprintf(text, sizeof text, "%*.*f", SACS_WIDTH, decimals, x) <= SACS_WIDTH) {
            fputs(text, f);
            return;
        }
    snprintf(text, sizeof text, "%.1E", x); /* "-1.2E+06" has eight columns, "-1.2E6" fits */
    char *sign = strchr(text, '+');
    if (sign) memmove(sign, sign + 1 + strspn(sign + 1, "0"), strlen(sign + 1 + strspn(sign + 1, "0")) + 1);
    fprintf(f, "%*s", SACS_WIDTH, text);
}

static void write_sacs_head(FILE *f, const fl_series *s, const char *part)
{
    (void)s;
    fprintf(f,
            "* Ice load on part %s, kN and kN.m, at the reference point of the moments: a joint of that "
            "name, at\n"
            "* that point, is expected; a load condition for each time\n",
            part);
}

static void write_sacs_row(FILE *f, const char *part, int32_t k, double t, const double load[LOADS])
{
    char joint[5];
    snprintf(joint, sizeof joint, "%s", strcmp(part, "total") == 0 ? "ICE" : part);
    fprintf(f, "LOADCN%5d\nLOADLB%5d ICE AT %.6g S\nLOAD   %-4s     ", k + 1, k + 1, t, joint);
    for (int i = 0; i < LOADS; i++) {
        if (i == 4) fputc(' ', f);
        write_sacs_number(f, load[i]);
    }
    fputs(" GLOB JOIN\n", f);
}

/* --- all ------------------------------------------------------------------------------------------------ */

static const struct export_form FORM[] = {
    {"openfast", "", 1.0, write_openfast_head, write_openfast_row, NULL, 0},
    {"orcaflex", NULL, 1e-3, write_orcaflex_head, write_orcaflex_row, NULL, 0},
    {"ansys", "! ", 1.0, write_ansys_head, write_ansys_row, write_ansys_end, 0},
    {"sacs", "* ", 1e-3, write_sacs_head, write_sacs_row, NULL, SACS_MOST}};

const char *export_form_name(int k) { return k < (int)(sizeof FORM / sizeof *FORM) ? FORM[k].name : NULL; }

static void write_load_row(FILE *f, const struct export_form *form, int32_t at, double t, const fl_series *s,
                           int32_t k)
{
    double load[LOADS];
    for (int i = 0; i < LOADS; i++) load[i] = form->scale * s->x[i][k];
    form->row(f, s->part[0], at, t, load);
}

static void write_rows(FILE *f, const struct export_form *form, const fl_series *s)
{
    write_load_row(f, form, 0, s->edge[0], s, 0);
    for (int32_t k = 0; k < s->n; k++)
        write_load_row(f, form, k + 1, 0.5 * (s->edge[k] + s->edge[k + 1]), s, k);
    write_load_row(f, form, s->n + 1, s->edge[s->n], s, s->n - 1);
}

int export_loads(const struct options *o, fl_err *err)
{
    const fl_record_selection selection = {.signal = LOAD,
                                           .signals = LOADS,
                                           .part = o->part ? o->part : "total",
                                           .about = o->abouts ? o->about : NULL,
                                           .from = settings_from(o),
                                           .to = o->to,
                                           .last = o->window,
                                           .after_first_load = settings_after_first_load(o),
                                           .reduction = o->over,
                                           .where = o->where,
                                           .wheres = o->wheres};
    const struct export_form *form = &FORM[o->exports - 1];
    fl_series s = {0};
    fl_out out = {0};
    fl_history_line by;
    fl_resampling_loss loss[LOADS];
    char step[FL_NUMBER_LEN], text[RUN_END_NOTE];
    int rc = -1;
    if (fl_series_read(&s, o->in, &selection, err)) return -1;
    if (o->step > 0.0 && fl_resample_uniform(&s, o->step, loss, err)) goto done;
    if (form->most && s.n + 2 > form->most) {
        fl_fail(err, FL_INPUT,
                "%d rows found, %s has room for %d: --step, --from, --to or --window is expected", s.n + 2,
                form->name, form->most);
        goto done;
    }
    fl_history_line_start(&by, "loadstats");
    fl_history_line_add(&by, "--export %s", form->name);
    fl_history_line_word(&by, "--part ", s.part[0]);
    if (o->step > 0.0) fl_history_line_add(&by, "--step %s", fl_number_text(o->step, step));
    if (fl_out_open(&out, o->out, o->gzip, err)) goto done;
    if (form->comment) write_history(out.f, form, &s, by.text);
    form->head(out.f, &s, s.part[0]);
    write_rows(out.f, form, &s);
    if (form->end) form->end(out.f, s.part[0]);
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
