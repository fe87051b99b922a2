/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot.h -- pictures by gnuplot. */
#ifndef LOADSTATS_PLOT_H
#define LOADSTATS_PLOT_H
#include "statrows.h"

/* Write into the folder o->plot, made if need be, for each part P (for the total alone, when it is the sum of
 * one part):
 *     history-P.tsv  history-P.gp  history-P.svg      the signals against time
 *     peaks-P.tsv    peaks-P.gp    peaks-P.svg        classes and exceedance of their peaks
 * The .gp files draw the .svg (or .png) again when run by gnuplot in that folder.  What a picture cannot
 * show is left out of its data: a long history is thinned to the smallest and the largest value of each
 * stretch, and ranks beyond the 200th to steps of a hundredth.
 * 0, or -1 with FL_USAGE (too many parts) or FL_SYSTEM (gnuplot missing or failing, a file not written) in
 * err. */
int plot(const struct result *r, const struct options *o, const fl_by *by, fl_err *err);

/* Print a text of a gnuplot script, between single quotes. */
void plot_quoted(FILE *f, const char *text);

/* Run gnuplot on DIR/STEM.gp, which must write to the file named in the variable out, and name what it drew
 * DIR/STEM.FORMAT when it is complete.  0, or -1 with FL_SYSTEM in err. */
int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

#endif
