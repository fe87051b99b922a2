/* SPDX-License-Identifier: GPL-3.0-or-later */
/* where.h -- which rows of a table are looked at: those that hold given words in given columns. */
#ifndef FL_STAT_WHERE_H
#define FL_STAT_WHERE_H
#include "base/table.h"

enum { FL_WHERE_MAX = 16 };

typedef struct {
    int32_t n, col[FL_WHERE_MAX];
    const char *word[FL_WHERE_MAX]; /* borrowed from the text of the conditions */
} fl_where;

/* Take conditions "COLUMN=WORD" on the columns of a table.
 * 0, or -1 with FL_USAGE (too many, or none in form) or FL_INPUT (no such column) in err. */
int fl_where_make(fl_where *w, const fl_table *t, const char *const *text, int32_t n, fl_err *err);

/* Does the row the table stands at meet all of them? */
int fl_where_holds(const fl_where *w, const fl_table *t);

#endif
