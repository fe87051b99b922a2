/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot_ensemble.h -- pictures of an ensemble: mean and largest value with intervals, against the number of
 * runs. */
#ifndef LOADSTATS_PLOT_ENSEMBLE_H
#define LOADSTATS_PLOT_ENSEMBLE_H
#include "base/tool.h"
#include "table_summary.h"

/* Draw ensemble-1, ensemble-2, ... for each signal into the folder o->plot, created if needed.
 * 0, or -1 with FL_USAGE (too many signals) or FL_SYSTEM in err. */
int plot_ensemble(const struct run_set *runs, const struct options *o, const fl_history_line *by,
                  fl_err *err);

#endif
