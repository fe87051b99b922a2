/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_parts.h -- the tables legs and events: parts of a structure side by side, and peaks as events. */
#ifndef LOADSTATS_TABLE_PARTS_H
#define LOADSTATS_TABLE_PARTS_H
#include "table_stats.h"

/* The names of the columns after those that all tables have. */
void parts_header(FILE *f, const struct options *o);

/* All rows of the table o->table, TABLE_LEGS or TABLE_EVENTS: legs signal by signal, events part by part. */
void parts_write(FILE *f, const struct result *r, const struct options *o);

/* Draw the picture legs into the folder o->plot, which exists: mean, significant and largest value of each
 * part, signal by signal.  0, or -1 with FL_SYSTEM in err. */
int plot_parts(const struct result *r, const struct options *o, const fl_history_line *by, fl_err *err);

#endif
