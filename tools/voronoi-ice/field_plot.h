/* SPDX-License-Identifier: GPL-3.0-or-later */
/* field_plot.h -- pictures of a field, drawn by gnuplot. */
#ifndef VORONOI_ICE_FIELD_PLOT_H
#define VORONOI_ICE_FIELD_PLOT_H
#include "ice/floes.h"
#include "floe_sizing.h"
#include "recipe.h"

enum { PLOT_FLOES = 20000, PLOT_RANKS = 200 };

/* Write into the folder o->plot, which is created if absent:
 *     plan.tsv   plan.gp   plan.svg     plan view of the floes, coloured by diameter
 *     sizes.tsv  sizes.gp  sizes.svg    number of floes larger than D against D, with the requested law
 * gnuplot draws the .svg (or .png) again from a .gp file in that folder.  Of more than PLOT_FLOES floes
 * the plan shows those in the middle of the field.  sizes.tsv has all ranks up to PLOT_RANKS, then every
 * hundredth of the rank.  sizing is NULL without --sizes. Returns 0, or -1 with FL_SYSTEM (gnuplot missing
 * or failing, a file not written). */
int plot_field(const struct recipe *o, const fl_floes *floes, const struct floe_sizing *sizing,
               const fl_history_line *by, fl_err *err);

#endif
