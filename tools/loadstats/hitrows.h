/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hitrows.h -- where the load is: the tables pressure-area, line-load and map, of contacts or of panels. */
#ifndef LOADSTATS_HITROWS_H
#define LOADSTATS_HITROWS_H
#include "base/err.h"
#include "options.h"

/* Is this work for hitrows_run()? */
int hitrows_wanted(const struct options *o);

/* Read the input and write table, pictures and report.  0, or -1 with err. */
int hitrows_run(const struct options *o, fl_err *err);

#endif
