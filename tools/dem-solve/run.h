/* SPDX-License-Identifier: GPL-3.0-or-later */
/* run.h -- run a world to the end of its scene: steps, tables, checkpoints. */
#ifndef DEM_SOLVE_RUN_H
#define DEM_SOLVE_RUN_H
#include "run_context.h"

/* -1 as fl_step(), or FL_SYSTEM when an output cannot be written; what was written until then is complete and
 * has its name. */
int run_scene(struct run *r, fl_err *err);

#endif
