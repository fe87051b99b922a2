/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot.h -- all pictures of a record, by gnuplot. */
#ifndef LOADSTATS_PLOT_H
#define LOADSTATS_PLOT_H
#include "base/err.h"
#include "base/tool.h"
#include "cell.h"
#include "settings.h"

/* Write into the folder o->plot, created if needed, for each part P (for the total alone, when it is the sum
 * of one part):
 *     history-P.tsv  history-P.gp  history-P.svg      signals against time
 *     peaks-P.tsv    peaks-P.gp    peaks-P.svg        classes and exceedance of their peaks
 * and the picture of the table, table_kind.h; in a report the pictures of all tables that the record
 * supports. The .gp files draw the .svg (or .png) again when run by gnuplot in that folder.  The data are
 * reduced to what a picture resolves: a long history to the smallest and the largest value of each stretch,
 * ranks beyond the 200th to steps of a hundredth. 0, or -1 with FL_USAGE (too many parts) or FL_SYSTEM
 * (gnuplot missing or failing, a file not written) in err. */
int plot_record(const struct record_views *r, const struct options *o, const fl_history_line *by,
                fl_err *err);

#endif
