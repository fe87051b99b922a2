/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_plot.h -- pictures of a packing: sieve curves asked and got, the plan or a section, the fabric rose. */
#ifndef PACK_PACK_PLOT_H
#define PACK_PACK_PLOT_H
#include "pack_run.h"

/* Into the folder o->plot: grading, section and fabric, each with its data and its script. */
int pack_plot(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err);

#endif
