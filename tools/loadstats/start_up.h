/* SPDX-License-Identifier: GPL-3.0-or-later */
/* start_up.h -- leaves out start-ups that are sure, startup.h, of one record and of several runs. */
#ifndef LOADSTATS_START_UP_H
#define LOADSTATS_START_UP_H
#include "base/err.h"
#include "stat/series.h"
#include "settings.h"

enum { START_NOTE = 400 };

/* Leave out the start-up of a record, where it is sure and the whole record of a run of dem-solve is asked
 * for.
 *    note  out: the line that says so, "" otherwise
 * Returns 0, or -1 with FL_SYSTEM. */
int start_up_drop(fl_series *s, const struct options *o, char note[START_NOTE], fl_err *err);

/* The time from which the runs of o->file count: the latest end of a start-up that is sure, so that all runs
 * have equal times.  It is o->from where none is sure, where it is beyond half of the shortest run, where a
 * cut was given, or a file cannot be read twice. Returns 0, or -1 with the errors of fl_series_read(). */
int start_up_of_runs(const struct options *o, double *from, char note[START_NOTE], fl_err *err);

#endif
