/* SPDX-License-Identifier: GPL-3.0-or-later */
/* path_plot.h -- pictures of a path by gnuplot, with the data and scripts they are made of. */
#ifndef ARC_PATH_PATH_PLOT_H
#define ARC_PATH_PATH_PLOT_H
#include "member/member_chain.h"
#include "member/path_table.h"
#include "options.h"

/* Makes the folder.  -1 with FL_SYSTEM. */
int path_plot_begin(const struct options *o, fl_err *err);

/* Shape of a point: shape-N.tsv, and shape-N.dat, shape-N.gp and the picture. */
int path_plot_shape(const struct options *o, const fl_member_model *m, const fl_member_chain *c,
                    int64_t point, fl_err *err);

/* Load factor against the displacement along the load, beside the reference. */
int path_plot_curve(const struct options *o, const fl_path_table *t, fl_err *err);

#endif
