/* SPDX-License-Identifier: GPL-3.0-or-later */
/* targets.h -- no output of a run may be one of its inputs, whatever the two are called. */
#ifndef DEM_SOLVE_TARGETS_H
#define DEM_SOLVE_TARGETS_H
#include "options.h"
#include "scene/scene.h"

/* -1 with FL_USAGE where a file that would be written is one that is read: by another name, through a link,
 * an included scene, a track.  A checkpoint may be the one that is gone on from. */
int targets_check(const fl_scene *s, const struct options *o, fl_err *err);

#endif
