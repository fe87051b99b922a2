/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fixed_columns.h -- rows of numbers in columns, as a FORTRAN format lays them out. */
#ifndef FL_MESH_FIXED_COLUMNS_H
#define FL_MESH_FIXED_COLUMNS_H
#include <stdint.h>
#include "base/err.h"

enum {
    FL_COLUMNS = 64,      /* of a row, at most */
    FL_COLUMN_WIDTH = 80, /* characters of a column, with the closing nul */
};

typedef struct {
    int n, start[FL_COLUMNS], width[FL_COLUMNS];
    int integers; /* columns of whole numbers before the first of another kind */
} fl_columns;

/* Read "(3i9,6e21.13e3)": so many columns of that width, each; i for whole numbers, e f d g for real ones, a
 * for text, x for what is passed over.  0, or -1 when that is not a format. */
int fl_columns_parse(fl_columns *f, const char *format);

/* Column k of a row of len characters, which ends in a zero byte: without the blanks about it into text,
 * which is returned; "" where the row is too short, and for a column that is not there. */
const char *fl_columns_text(const fl_columns *f, int k, const char *row, int32_t len,
                            char text[FL_COLUMN_WIDTH]);

/* The same as a whole number (up to 18 digits) and as a finite real one (fl_deck_real(), so that the E may be
 * left out); 0 for a blank column.  Numbers may touch: a column ends where it ends, and the row is the same
 * afterwards.  0, or -1 when it is anything else. */
int fl_columns_integer(const fl_columns *f, int k, const char *row, int32_t len, int64_t *x);
int fl_columns_real(const fl_columns *f, int k, char *row, int32_t len, double *x);

#endif
