/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run_record.h -- what tables tell about their run after their heads, as comments: warnings and the closing
 * report in the loads, and in every table of a run that ended early where and why.
 *
 * The lines are the same for any number of threads, any checkpoints, and a run that was stopped and resumed,
 * as the rows are: no time of the clock is among them.  Frames have none, as other programs read them. */
#ifndef DEM_SOLVE_RUN_RECORD_H
#define DEM_SOLVE_RUN_RECORD_H
#include "outputs.h"

/* Print the warnings before the first step, and write them into the loads. */
int record_start(const struct run *r, struct outputs *u, fl_err *err);

/* Lines of a run that goes on with another step or duration than its checkpoint has; before: the duration of
 * the checkpoint [s]. */
void record_changes(const struct run *r, struct outputs *u, double before, const int is_new[TABLES]);

/* The end of a run, before the tables are closed: print the warnings, write warnings and report into the
 * loads, and if the run ended early the last line of each table.  why: the failure that ended it, or no code.
 * -1 with FL_SYSTEM in err. */
int record_end(const struct run *r, struct outputs *u, const fl_err *why, int signal, fl_err *err);

#endif
