/* SPDX-License-Identifier: GPL-3.0-or-later */
/* time_rows.h -- columns of a table in memory, found by time: contacts(5), bonds(5), any table with a
 * number of a body, and the load curve of loads(5). */
#ifndef FL_VIEW_TIME_ROWS_H
#define FL_VIEW_TIME_ROWS_H
#include <stdint.h>
#include "base/err.h"

enum { FL_TIME_ROWS_COLUMNS = 16 };

typedef struct {
    int columns;
    int64_t rows, cap;
    double *x;      /* [rows columns] */
    int64_t *first; /* [times + 1] rows of a time */
    double *t;      /* [times] rising; one time of NAN: the table has no time */
    int32_t times, time_cap, first_cap;
    char unit[FL_TIME_ROWS_COLUMNS][24]; /* of the columns */
} fl_time_rows;

/* Reads columns by name.  kind NULL: any table.  words: for the column `word_column` (-1: none) the words
 * whose place is its value, ends with NULL; others are an error.  The time column is t, where there is
 * one.  -1 with FL_INPUT (a column is missing, times that go back) or FL_SYSTEM. */
int fl_time_rows_read(fl_time_rows *r, const char *path, const char *kind, const char *const *name,
                      int columns, int word_column, const char *const *words, fl_err *err);

/* The rows of the last time at or before t; where t is before all, of the first.  *a = *b: none. */
void fl_time_rows_at(const fl_time_rows *r, double t, int64_t *a, int64_t *b);

/* The load curve: a component of loads(5), fx, fy, fz or fh (horizontal), of one part or summed over all
 * (NULL). */
typedef struct {
    double *t, *y;
    int64_t n, cap;
} fl_load_curve;
int fl_load_curve_read(fl_load_curve *c, const char *path, const char *component, const char *part,
                       fl_err *err);

/* Both accept a zeroed struct and leave one. */
void fl_time_rows_free(fl_time_rows *r);
void fl_load_curve_free(fl_load_curve *c);

#endif
