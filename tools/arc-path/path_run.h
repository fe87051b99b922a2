/* SPDX-License-Identifier: GPL-3.0-or-later */
/* path_run.h -- a run of arc-path: model, imperfections, points, table, checkpoint, pictures. */
#ifndef ARC_PATH_PATH_RUN_H
#define ARC_PATH_PATH_RUN_H
#include "options.h"

int path_run(const struct options *o, fl_err *err);

#endif
