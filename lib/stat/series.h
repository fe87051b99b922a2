/* SPDX-License-Identifier: GPL-3.0-or-later */
/* series.h -- signals against time in memory, for each part of a structure and for their sum.
 *
 * Row k holds for the time edge[k] .. edge[k + 1]; see record.h. */
#ifndef FL_STAT_SERIES_H
#define FL_STAT_SERIES_H
#include <stdint.h>
#include "base/err.h"
#include "stat/record.h"

typedef struct {
    char kind[32];
    char *history;   /* of the table, or NULL */
    char *run_lines; /* "#set" and "#report" lines of its run, or NULL */
    int has_motion;  /* the table has velocities of the parts */
    enum fl_run_end end;
    char why[FL_RUN_END_TEXT]; /* of a run that stopped */
    int32_t n;                 /* rows in time, n >= 1 */
    double *t;                 /* [n] as written in the table [s] */
    double *edge;              /* [n + 1] rising [s] */
    int32_t parts, signals;
    char **part;           /* [parts] the sum over the parts is the last one, "total" */
    char **signal, **unit; /* [signals] */
    double **x;            /* [parts * signals] -> [n], of part p and signal s at x[p * signals + s];
                             * NULL where the sum over parts is meaningless */
} fl_series;

/* Read a table with fl_record_open() and fl_record_next(), and apply the cut.
 * 0, or -1 with their errors, or FL_INPUT when no row is left. */
int fl_series_read(fl_series *s, const char *path, const fl_record_selection *selection, fl_err *err);

/* Leave out the first rows, fewer than n. */
void fl_series_drop_first(fl_series *s, int32_t rows);

/* Accepts a zeroed struct and leaves one. */
void fl_series_free(fl_series *s);

#endif
