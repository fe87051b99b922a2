/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table.h -- a table read as a stream: "#KIND VERSION", the history, one row of column names, rows of fields.
 *
 *     #loads 1
 *     #by dem-solve 0.1.0 tower.scene
 *     #start 0
 *     t[s]	part	fx[N]	...
 *     0.01	tower	1250.5	...
 *
 * Memory does not grow with the number of rows. */
#ifndef FL_BASE_TABLE_H
#define FL_BASE_TABLE_H
#include "base/text.h"

enum { FL_TABLE_COLUMNS_MAX = 4096 }; /* more are refused: the file is not one of ours */

typedef struct {
    fl_text text; /* kind, history and the place for messages are in here */
    char *header; /* the row of names, cut in place */
    char **name;  /* [n] without the unit */
    char **unit;  /* [n] without the brackets, "" when there is none */
    int32_t n;    /* columns */
    double start; /* of "#start T" above the row of names: when the first interval begins [s], else 0 */
    int has_start;
} fl_table;

/* Open a table and read as far as the row of names.  kind NULL takes any kind.
 * 0, or -1 with FL_INPUT (missing, of another kind, newer, no row of names, a name twice) or FL_SYSTEM. */
int fl_table_open(fl_table *t, const char *path, const char *kind, int newest, fl_err *err);

/* The column called name, with or without its unit ("fx" or "fx[N]"); -1 when there is none. */
int32_t fl_table_column(const fl_table *t, const char *name);

/* The same, but a column that is missing is FL_INPUT in err, and the nearest name is told. */
int fl_table_require(const fl_table *t, const char *name, int32_t *col, fl_err *err);

/* Next row, which must have as many fields as there are columns.  1, 0 at the end, or -1 with err. */
int fl_table_row(fl_table *t, fl_err *err);

/* A field of the row as a word (valid until the next row) and as a finite number. */
const char *fl_table_word(const fl_table *t, int32_t col);
int fl_table_f64(const fl_table *t, int32_t col, double *x, fl_err *err);

/* The same of a number of at most that size. */
int fl_table_f64_bounded(const fl_table *t, int32_t col, double most, double *x, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_table_close(fl_table *t);

#endif
