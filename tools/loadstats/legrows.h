/* SPDX-License-Identifier: GPL-3.0-or-later */
/* legrows.h -- the tables legs and events: parts of a structure side by side, and peaks as events. */
#ifndef LOADSTATS_LEGROWS_H
#define LOADSTATS_LEGROWS_H
#include "statrows.h"

/* The names of the columns after those that all tables have. */
void legrows_header(FILE *f, const struct options *o);

/* All rows of the table o->table, TABLE_LEGS or TABLE_EVENTS: legs signal by signal, events part by part. */
void legrows_write(FILE *f, const struct result *r, const struct options *o);

/* Draw the picture legs into the folder o->plot, which exists: mean, significant and largest value of each
 * part, signal by signal.  0, or -1 with FL_SYSTEM in err. */
int legrows_plot(const struct result *r, const struct options *o, const fl_by *by, fl_err *err);

#endif
