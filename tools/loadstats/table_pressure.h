/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_pressure.h -- where the load is: the tables pressure-area, line-load and map, of contacts or of panels. */
#ifndef LOADSTATS_TABLE_PRESSURE_H
#define LOADSTATS_TABLE_PRESSURE_H
#include "base/err.h"
#include "options.h"

/* Is this work for pressure_run()? */
int pressure_selected(const struct options *o);

/* Read the input and write table, pictures and report.  0, or -1 with err. */
int pressure_run(const struct options *o, fl_err *err);

#endif
