/* SPDX-License-Identifier: GPL-3.0-or-later */
/* byline.h -- the history line of a table: what was asked for and is not the default, in one order. */
#ifndef LOADSTATS_BYLINE_H
#define LOADSTATS_BYLINE_H
#include "options.h"

/* Of a run, with the names of its files. */
void byline_run(const struct options *o, fl_by *by);

/* Of a summary: one line, "#by ...\n", without the names of files, for by[FL_BY_MAX + 2]. */
void byline_summary(const struct options *o, char *by);

#endif
