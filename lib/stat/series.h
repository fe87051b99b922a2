/* SPDX-License-Identifier: GPL-3.0-or-later */
/* series.h -- signals against time, for each part of a structure and for their sum.
 *
 * A row of a loads table is the mean over the interval that ends at its time; a row of any other table is a
 * sample at its time, and stands for what is nearer to it than to its neighbours (at the ends as far outward
 * as inward).  Either way row k holds for the time edge[k] .. edge[k + 1], and all statistics weigh it so. */
#ifndef FL_STAT_SERIES_H
#define FL_STAT_SERIES_H
#include <stdint.h>
#include "base/err.h"

/* Larger values are refused: no load is near it, and squares and sums of any number of rows stay finite. */
#define FL_SERIES_LARGEST 1e100

typedef struct {
    char kind[32];
    char *history; /* the "#by" lines of the table, or NULL */
    int32_t n;     /* rows in time, n >= 1 */
    double *t;     /* [n] as written in the table [s] */
    double *edge;  /* [n + 1] rising [s] */
    int32_t parts, signals;
    char **part;           /* [parts] the sum over the parts is the last one, "total" */
    char **signal, **unit; /* [signals] */
    double **x;            /* [parts * signals] -> [n], of part p and signal s at x[p * signals + s];
                             * NULL where the sum over parts would mean nothing */
} fl_series;

/* What to read.
 *   signal[signals]  columns, or fh = sqrt(fx^2 + fy^2), or f = sqrt(fx^2 + fy^2 + fz^2), for the total
 *                    of the summed components; signals = 0 takes fx, fy, fz, fh of a loads table
 *   part             one part or "total"; NULL takes all of them and the total
 *   from, to         only rows whose interval lies within [s]; -INFINITY and INFINITY take all
 *   last             only the rows of the last so many seconds; 0 takes all */
typedef struct {
    const char *const *signal;
    int32_t signals;
    const char *part;
    double from, to, last;
} fl_series_ask;

/* Read a table that has a column t and, where rows share a time, a column part or body that tells them apart.
 * Every part must have one row at each time.  A table without such a column has one part, "-".  The total is
 * the sum over the parts of fx, fy, fz, mx, my, mz and contacts; other columns have none.
 * 0, or -1 with FL_INPUT (no rows, none left by the cut, a missing or repeated part, time that does not
 * rise, a field that is not a number or beyond FL_SERIES_LARGEST), FL_USAGE (a total that does not exist, or
 * signals needed) or FL_SYSTEM. */
int fl_series_read(fl_series *s, const char *path, const fl_series_ask *ask, fl_err *err);

/* The index of a part, or -1. */
int32_t fl_series_part(const fl_series *s, const char *name);

/* Accepts a zeroed struct and leaves one. */
void fl_series_free(fl_series *s);

#endif
