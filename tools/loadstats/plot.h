/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plot.h -- pictures by gnuplot. */
#ifndef LOADSTATS_PLOT_H
#define LOADSTATS_PLOT_H
#include "statrows.h"

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
int plot(const struct result *r, const struct options *o, const fl_by *by, fl_err *err);

/* A factor and the prefix of the unit that goes with it: newtons and pascals in thousands or millions, so
 * that the axis of values up to `large` in size has short numbers. */
typedef struct {
    double factor;
    const char *prefix;
} plot_scale;
plot_scale plot_scale_of(const char *unit, double large);

/* "Horizontal force  [kN]" for "fh", "N" and values up to large in size; unit may be "". */
void plot_axis(char *label, size_t size, const char *signal, const char *unit, double large);

/* What a script begins with: how to run it, terminal, size in pixels, output, data = the name of its data. */
void plot_open(FILE *f, const char *stem, const char *format, int width, int height);

/* DIR/STEM.END.  0, or -1 with FL_SYSTEM in err when it is too long. */
enum { PLOT_PATH_LEN = 4096 };
int plot_path(char path[PLOT_PATH_LEN], const char *dir, const char *stem, const char *end, fl_err *err);

/* Print a text of a gnuplot script, between single quotes. */
void plot_quoted(FILE *f, const char *text);

/* Run gnuplot on DIR/STEM.gp, which must write to the file named in the variable out, and name what it drew
 * DIR/STEM.FORMAT when it is complete.  0, or -1 with FL_SYSTEM in err. */
int plot_draw(const char *dir, const char *stem, const char *format, fl_err *err);

#endif
