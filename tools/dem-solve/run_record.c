/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "run_record.h"
#include <stdlib.h>
#include "base/number_text.h"
#include "out/tables.h"
#include "report.h"
#include "warnings.h"
#include "world/access.h"

/* Status of a program that a signal ended, as a shell has it. */
enum { STATUS_OF_SIGNAL = 128 };

/* What begins a message, and is not repeated in a table. */
static const char PROGRAM[] = "dem-solve: ";

/* Close a text in memory; NULL with err. */
static char *finish_text(FILE *f, char **text, int bad, fl_err *err)
{
    if ((f && fclose(f) != 0) || bad) {
        if (!err->code) fl_fail(err, FL_SYSTEM, "out of memory for the lines of a table");
        free(*text);
        return NULL;
    }
    return *text;
}

int record_start(const struct run *r, struct outputs *u, fl_err *err)
{
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    if (f) warn_at_start(r, f);
    if (!finish_text(f, &text, !f, err)) return -1;
    fputs(text, stderr);
    fl_table_write_report(u->table[TABLE_LOADS].f, text, PROGRAM);
    free(text);
    return 0;
}

void record_changes(const struct run *r, struct outputs *u, double before, const int is_new[TABLES])
{
    char number[FL_NUMBER_LEN];
    for (int k = 0; k < TABLES; k++) {
        FILE *const f = u->table[k].f;
        if (!f || k == TABLE_FRAMES || is_new[k]) continue;
        if (r->step_change[0]) fl_table_write_report(f, r->step_change, PROGRAM);
        if (r->scene->run.duration != before)
            fprintf(f, "#set run.duration = %s s\n", fl_number_text(r->scene->run.duration, number));
    }
}

int record_end(const struct run *r, struct outputs *u, const fl_err *why, int signal, fl_err *err)
{
    FILE *const loads = u->table[TABLE_LOADS].f;
    char *text = NULL;
    size_t n = 0;
    FILE *f = open_memstream(&text, &n);
    if (f) warn_at_end(r, why->code != FL_DONE, f);
    if (!finish_text(f, &text, !f, err)) return -1;
    fputs(text, stderr);
    if (loads && !ferror(loads)) fl_table_write_report(loads, text, PROGRAM);
    free(text);
    text = NULL;
    f = open_memstream(&text, &n);
    if (f) write_report(r, f, REPORT_OF_RECORD);
    if (!finish_text(f, &text, !f, err)) return -1;
    if (loads && !ferror(loads)) fl_table_write_report(loads, text, PROGRAM);
    free(text);
    for (int k = 0; k < TABLES && (why->code || signal); k++) {
        FILE *const t = u->table[k].f;
        if (!t || k == TABLE_FRAMES || ferror(t)) continue;
        fl_table_write_stopped(t, signal ? STATUS_OF_SIGNAL + signal : (int)why->code, fl_world_time(r->w),
                               signal == SIGPIPE ? "the reader of an output ended"
                               : signal          ? "by a signal"
                                                 : why->text);
    }
    return 0;
}
