/* SPDX-License-Identifier: GPL-3.0-or-later */
/* row_filter.h -- selects the rows of a table that hold given words in given columns. */
#ifndef FL_STAT_ROW_FILTER_H
#define FL_STAT_ROW_FILTER_H
#include "base/table.h"

enum { FL_ROW_FILTER_MAX = 16 };

typedef struct {
    int32_t n, col[FL_ROW_FILTER_MAX];
    const char *word[FL_ROW_FILTER_MAX]; /* borrowed from the text of the conditions */
} fl_row_filter;

/* Parse conditions "COLUMN=WORD" on the columns of a table.
 * 0, or -1 with FL_USAGE (too many, or malformed) or FL_INPUT (no such column) in err. */
int fl_row_filter_make(fl_row_filter *w, const fl_table *t, const char *const *text, int32_t n, fl_err *err);

/* True if the current row of the table meets all conditions. */
int fl_row_filter_matches(const fl_row_filter *w, const fl_table *t);

#endif
