/* SPDX-License-Identifier: GPL-3.0-or-later */
/* html_report.h -- the report: one self-contained HTML page. */
#ifndef LOADSTATS_HTML_REPORT_H
#define LOADSTATS_HTML_REPORT_H
#include <stdio.h>
#include "base/err.h"
#include "settings.h"

/* The subject of a report. */
typedef struct {
    const void *what; /* passed to the functions below */
    const char *title;
    int many;              /* many runs, not one record */
    int legs;              /* there are two parts or more to compare */
    int alone;             /* pictures and the table o->table only */
    int spectra;           /* there are enough rows for a spectrum */
    const char *history;   /* of the input, or NULL */
    const char *run_lines; /* scene and closing report of its run, or NULL */
    double span;           /* duration of the data [s] */
    /* Print the paragraph below the title, as HTML. */
    void (*intro)(FILE *f, const void *what);
    /* Print the table o->table, as loadstats does.  0, or -1 with err. */
    int (*table)(FILE *f, const void *what, const struct options *o, fl_err *err);
    /* Draw the pictures into the folder o->plot.  0, or -1 with err. */
    int (*draw)(const void *what, const struct options *o, fl_err *err);
} report_source;

/* Write o->report: the tables that have a position in the report and whose needs are met (table_kind.h), the
 * table of --table where it is another, the pictures as inline SVG, and the "#by" lines that reproduce all
 * of it. Numbers are rounded to six digits.  The pictures are drawn in a folder of TMPDIR that is removed
 * again.  0, or -1 with the errors of the functions above or FL_SYSTEM in err. */
int html_report_write(const report_source *from, const struct options *o, fl_err *err);

#endif
