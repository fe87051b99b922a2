/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_summary.h -- what loadstats does in constant memory: summaries of runs, what they add up to, and tables of
 * them, for many files or while a record grows. */
#ifndef LOADSTATS_TABLE_SUMMARY_H
#define LOADSTATS_TABLE_SUMMARY_H
#include "base/err.h"
#include "options.h"

/* Is this work for summary_run()? */
int summary_selected(const struct options *o);

/* Read all inputs and print the table that was asked for.  0, or -1 with err. */
int summary_run(const struct options *o, fl_err *err);

#endif
