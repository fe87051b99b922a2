/* SPDX-License-Identifier: GPL-3.0-or-later */
/* unused_keys.h -- keys that bear on nothing, as what they belong to was never asked for.
 *
 * The speed of an inflow without an inflow, a height of waves without waves: a slip, after which the run is
 * of another case than was meant.  Where the key they need is given, if only to say that it is off, they may
 * stay: `--set boundary.inflow=none` turns a case into its twin.  Intervals of outputs that are not written
 * may stand, too, for those come from the command line as often. */
#ifndef FL_SCENE_UNUSED_KEYS_H
#define FL_SCENE_UNUSED_KEYS_H
#include "scene/scene.h"

/* 0, or -1 with FL_INPUT and the line of the first such key. */
int fl_scene_check_unused(const fl_scene *scene, fl_err *err);

#endif
