/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table.h -- a table read as a stream: "#KIND VERSION", the history, one row of column names, rows of fields.
 *
 *     #loads 1
 *     #by dem-solve 0.1.0 tower.scene
 *     #set run.duration = 10 s
 *     #start 0
 *     t[s]	part	fx[N]	...
 *     0.01	tower	1250.5	...
 *     #report steps 1000 of 0.01 s
 *
 * Memory does not grow with the number of rows. */
#ifndef FL_BASE_TABLE_H
#define FL_BASE_TABLE_H
#include "base/text.h"

enum { FL_TABLE_COLUMNS_MAX = 4096 }; /* larger tables are refused: the file is of another kind */

typedef struct {
    fl_text text; /* kind, history and position for messages */
    char *header; /* the row of column names, split in place */
    char **name;  /* [n] without the unit */
    char **unit;  /* [n] without the brackets, "" if there is none */
    int32_t n;    /* columns */
    double start; /* "#start T" above the column names: start of the first interval [s], else 0 */
    int has_start;
} fl_table;

/* Opens a table and reads up to the column names.  kind NULL accepts any kind.
 * 0, or -1 with FL_INPUT (missing, other kind, newer, no column names, a repeated name) or FL_SYSTEM. */
int fl_table_open(fl_table *t, const char *path, const char *kind, int newest, fl_err *err);

/* Index of the column called name, with or without its unit ("fx" or "fx[N]"); -1 if there is none. */
int32_t fl_table_column(const fl_table *t, const char *name);

/* Same, but a missing column is an error, FL_INPUT; the message names the nearest name. */
int fl_table_require(const fl_table *t, const char *name, int32_t *col, fl_err *err);

/* Reads the next row, which must have one field per column.  1, 0 at the end, or -1 with err. */
int fl_table_row(fl_table *t, fl_err *err);

/* A field of the row as a word (valid until the next row), and as a finite number. */
const char *fl_table_word(const fl_table *t, int32_t col);
int fl_table_f64(const fl_table *t, int32_t col, double *x, fl_err *err);

/* Same for a number of magnitude at most `most`. */
int fl_table_f64_bounded(const fl_table *t, int32_t col, double most, double *x, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_table_close(fl_table *t);

#endif
