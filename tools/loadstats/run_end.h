/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run_end.h -- records of runs that ended early: what is said of them, and that they are no sample of their
 * case. */
#ifndef LOADSTATS_RUN_END_H
#define LOADSTATS_RUN_END_H
#include "settings.h"
#include "stat/record.h"

enum { RUN_END_NOTE = FL_RUN_END_TEXT + 200 };

/* A sentence for a warning: how the run of a record ended.  Returns text. */
const char *run_end_text(enum fl_run_end end, const char *why, char text[RUN_END_NOTE]);

/* Check a run, or the history of a summary, before it is counted among others: a run that stopped is refused
 * without --force, as it stopped in the state that stopped it.  A warning where it is counted or alone.
 * 0, or -1 with FL_INPUT. */
int run_end_check(const char *path, enum fl_run_end end, const char *why, const struct options *o,
                  fl_err *err);
int run_end_check_history(const char *path, const char *history, const struct options *o, fl_err *err);

#endif
