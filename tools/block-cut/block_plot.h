/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_plot.h -- pictures of blocks: the plan, a section, and an exploded view. */
#ifndef BLOCK_CUT_BLOCK_PLOT_H
#define BLOCK_CUT_BLOCK_PLOT_H
#include "block_result.h"
#include "options.h"

/* plan: z at mid-height; section: y in the middle; exploded: blocks moved apart from the centre by a third.
 * A block has one of a few colours by its number; in the exploded view a face has the colour of its joint
 * set. */
int block_plot(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err);

#endif
