/* SPDX-License-Identifier: GPL-3.0-or-later */
/* summary_file.h -- write and read a summary as a table of kind summary, see summary(5). */
#ifndef FL_STAT_SUMMARY_FILE_H
#define FL_STAT_SUMMARY_FILE_H
#include <stdio.h>
#include "stat/summary.h"

/* Print the table; multisets are sorted first, so equal summaries give equal bytes.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_summary_write(FILE *f, fl_summary *s, fl_err *err);

/* Read a table and add its summary to s, as fl_summary_merge().  0, or -1 with FL_INPUT or FL_SYSTEM in err;
 * s is then unchanged. */
int fl_summary_read(fl_summary *s, const char *path, fl_err *err);

#endif
