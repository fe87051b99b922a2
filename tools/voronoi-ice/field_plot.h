/* SPDX-License-Identifier: GPL-3.0-or-later */
/* field_plot.h -- pictures of the field by gnuplot. */
#ifndef VORONOI_ICE_FIELD_PLOT_H
#define VORONOI_ICE_FIELD_PLOT_H
#include "ice/floes.h"
#include "options.h"
#include "floe_sizing.h"

enum { CHART_FLOES = 20000, CHART_RANKS = 200 };

/* Write into the folder o->plot, made if need be:
 *     plan.tsv   plan.gp   plan.svg     the floes from above, coloured by their diameter
 *     sizes.tsv  sizes.gp  sizes.svg    how many floes are larger than D, against D, and the law asked for
 * The .gp files draw the .svg (or .png) again when run by gnuplot in that folder.  Of more than CHART_FLOES
 * floes the plan shows those in the middle of the field; of the ranks all up to CHART_RANKS, then steps of a
 * hundredth.  sizing is NULL where no sizes were asked for.
 * Returns 0, or -1 with FL_SYSTEM (gnuplot missing or failing, a file not written). */
int chart(const struct options *o, const fl_floes *floes, const struct sizing *sizing,
          const fl_history_line *by, fl_err *err);

#endif
