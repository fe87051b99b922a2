/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot.h -- pictures by gnuplot. */
#ifndef LOADSTATS_PLOT_H
#define LOADSTATS_PLOT_H
#include "picture.h"
#include "table_stats.h"

/* Write into the folder o->plot, made if need be, for each part P (for the total alone, when it is the sum of
 * one part):
 *     history-P.tsv  history-P.gp  history-P.svg      the signals against time
 *     peaks-P.tsv    peaks-P.gp    peaks-P.svg        classes and exceedance of their peaks
 * and with --table legs legs.tsv, legs.gp, legs.svg, the parts side by side.
 * The .gp files draw the .svg (or .png) again when run by gnuplot in that folder.  What a picture cannot
 * show is left out of its data: a long history is thinned to the smallest and the largest value of each
 * stretch, and ranks beyond the 200th to steps of a hundredth.
 * 0, or -1 with FL_USAGE (too many parts) or FL_SYSTEM (gnuplot missing or failing, a file not written) in
 * err. */
int plot(const struct result *r, const struct options *o, const fl_history_line *by, fl_err *err);

#endif
