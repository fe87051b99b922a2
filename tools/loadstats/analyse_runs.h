/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analyse_runs.h -- summaries of runs in constant memory: of many files, or of a record while it grows. */
#ifndef LOADSTATS_ANALYSE_RUNS_H
#define LOADSTATS_ANALYSE_RUNS_H
#include "base/err.h"
#include "settings.h"

/* True if the table is computed from summaries of runs. */
int runs_selected(const struct options *o);

/* Read all inputs, then write table, pictures and report.  0, or -1 with err. */
int analyse_runs(const struct options *o, fl_err *err);

#endif
