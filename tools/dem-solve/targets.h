/* SPDX-License-Identifier: GPL-3.0-or-later */
/* targets.h -- check that no output of a run is an input, or another output (base/output_guard.h). */
#ifndef DEM_SOLVE_TARGETS_H
#define DEM_SOLVE_TARGETS_H
#include "options.h"
#include "scene/scene.h"

/* loads: the path of the loads.  The checkpoint that is resumed may be replaced.  -1 with FL_USAGE. */
int targets_check(const fl_scene *s, const struct options *o, const char *loads, fl_err *err);

#endif
