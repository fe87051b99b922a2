/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_export.h -- writes the blocks: their cores, and a joint for each pair of faces. */
#ifndef BLOCK_CUT_BLOCK_EXPORT_H
#define BLOCK_CUT_BLOCK_EXPORT_H
#include "block_result.h"
#include "options.h"

/* The core of a block is its shape with the faces moved in by the radius.  A face that vanishes from the core
 * takes its joints along (lost_joints of r).  -1 with FL_INPUT (a block without a core), FL_SYSTEM. */
int block_export(const struct options *o, struct result *r, const fl_history_line *by, fl_err *err);

#endif
