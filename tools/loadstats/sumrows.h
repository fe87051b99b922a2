/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sumrows.h -- what loadstats does in constant memory: summaries of runs, what they add up to, and tables of
 * them, for many files or while a record grows. */
#ifndef LOADSTATS_SUMROWS_H
#define LOADSTATS_SUMROWS_H
#include "base/err.h"
#include "options.h"

/* Is this work for sumrows_run()? */
int sumrows_wanted(const struct options *o);

/* Read all inputs and print the table that was asked for.  0, or -1 with err. */
int sumrows_run(const struct options *o, fl_err *err);

#endif
