/* SPDX-License-Identifier: GPL-3.0-or-later */
/* html_report.h -- the report: one HTML page that needs no other file. */
#ifndef LOADSTATS_HTML_REPORT_H
#define LOADSTATS_HTML_REPORT_H
#include "table_stats.h"

/* What a page is about. */
typedef struct {
    const void *what; /* handed to the functions below */
    const char *title;
    int many;            /* many runs, not one record */
    int legs;            /* there are parts to compare */
    int alone;           /* nothing but the pictures and the table o->table */
    int spectra;         /* there are rows enough for a spectrum */
    const char *history; /* the "#by" lines of what was read, or NULL */
    double span;         /* how long it is [s] */
    /* Print the paragraph under the title, as HTML. */
    void (*intro)(FILE *f, const void *what);
    /* Print the table o->table, as loadstats does.  0, or -1 with err. */
    int (*table)(FILE *f, const void *what, const struct options *o, fl_err *err);
    /* Draw the pictures into the folder o->plot.  0, or -1 with err. */
    int (*draw)(const void *what, const struct options *o, fl_err *err);
} report_source;

/* Write o->report: the table stats (of many runs the table ensemble too), the laws of the peaks (of the
 * largest values), of several parts the table legs, return levels where --return asks for them, the tables
 * frequency, damage and, where there is an oscillator, response, the table of --table where it is another,
 * the pictures as inline SVG, and the "#by" lines from which all of it can be made again.  Numbers are
 * rounded to six digits. The pictures are drawn in a folder of TMPDIR that is removed again. 0, or -1 with
 * the errors of the functions above or FL_SYSTEM in err. */
int html_report_write(const report_source *from, const struct options *o, fl_err *err);

/* The same for one record. */
int html_report_write_record(const struct result *r, const struct options *o, fl_err *err);

#endif
