/* SPDX-License-Identifier: GPL-3.0-or-later */
/* summary_file.h -- a summary as a table of kind summary, see summary(5). */
#ifndef FL_STAT_SUMMARY_FILE_H
#define FL_STAT_SUMMARY_FILE_H
#include <stdio.h>
#include "stat/summary.h"

/* Print the table, for which bags of values are sorted: equal summaries give equal bytes.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_summary_write(FILE *f, fl_summary *s, fl_err *err);

/* Add the summary that a table holds to s, as fl_summary_merge().  0, or -1 with FL_INPUT or FL_SYSTEM in
 * err; s is then as it was. */
int fl_summary_read(fl_summary *s, const char *path, fl_err *err);

#endif
