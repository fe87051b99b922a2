/* SPDX-License-Identifier: GPL-3.0-or-later */
/* targets.h -- what a run writes is none of what it reads, and nothing is written twice (base/output_guard.h). */
#ifndef DEM_SOLVE_TARGETS_H
#define DEM_SOLVE_TARGETS_H
#include "options.h"
#include "scene/scene.h"

/* -1 with FL_USAGE; loads: where those go.  A checkpoint may be the one that is gone on from. */
int targets_check(const fl_scene *s, const struct options *o, const char *loads, fl_err *err);

#endif
