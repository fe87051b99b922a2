/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_run.h -- a run of block-cut. */
#ifndef BLOCK_CUT_BLOCK_RUN_H
#define BLOCK_CUT_BLOCK_RUN_H
#include "options.h"

int block_run(const struct options *o, fl_err *err);

#endif
