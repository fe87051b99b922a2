/* SPDX-License-Identifier: GPL-3.0-or-later */
/* history_line.h -- the history line of a table: the options that differ from their defaults, in a fixed
 * order. */
#ifndef LOADSTATS_HISTORY_LINE_H
#define LOADSTATS_HISTORY_LINE_H
#include "base/tool.h"
#include "settings.h"

/* Of a run, with the names of its files. */
void history_line_run(const struct options *o, fl_history_line *by);

/* Of a summary: one line, "#by ...\n", without the names of files, for by[FL_HISTORY_LINE_MAX + 2]. */
void history_line_summary(const struct options *o, char *by);

#endif
