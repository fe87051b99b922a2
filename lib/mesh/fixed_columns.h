/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fixed_columns.h -- rows of numbers in fixed columns, as a FORTRAN format describes them. */
#ifndef FL_MESH_FIXED_COLUMNS_H
#define FL_MESH_FIXED_COLUMNS_H
#include <stdint.h>
#include "base/err.h"

enum {
    FL_COLUMNS = 64,      /* limit per row */
    FL_COLUMN_WIDTH = 80, /* characters of a column, with the closing nul */
};

typedef struct {
    int n, start[FL_COLUMNS], width[FL_COLUMNS];
    int integers; /* integer columns before the first of another kind */
} fl_columns;

/* Parse a format like "(3i9,6e21.13e3)": repeat count, kind and width.  Kinds: i for integers, e f d g for
 * reals, a for text, x for skipped characters.  0, or -1 if it is no such format. */
int fl_columns_parse(fl_columns *f, const char *format);

/* Copy column k of a row of len characters, ended by a zero byte, into text without surrounding blanks and
 * return it.  Returns "" if the row is too short or has no such column. */
const char *fl_columns_text(const fl_columns *f, int k, const char *row, int32_t len,
                            char text[FL_COLUMN_WIDTH]);

/* Column k as an integer of up to 18 digits, or as a finite real as in fl_deck_real(), where the E may be
 * left out; 0 for a blank column.  Numbers may touch, since a column has a fixed end; the row is unchanged on
 * return.  0, or -1 for anything else. */
int fl_columns_integer(const fl_columns *f, int k, const char *row, int32_t len, int64_t *x);
int fl_columns_real(const fl_columns *f, int k, char *row, int32_t len, double *x);

#endif
