/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fitrows.h -- the tables fits and levels: laws of the extremes of a view, and how far they reach. */
#ifndef LOADSTATS_FITROWS_H
#define LOADSTATS_FITROWS_H
#include "statrows.h"

/* The names of the columns after those that all tables have. */
void fitrows_header(FILE *f, const struct options *o);

/* The rows of one view.  0, or -1 with FL_SYSTEM in err. */
int fitrows_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                  int w, fl_err *err);

#endif
