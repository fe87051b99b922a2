/* SPDX-License-Identifier: GPL-3.0-or-later */
/* unused_keys.h -- keys without effect, because the key they need was not given.
 *
 * Examples are the speed of an inflow without an inflow, or a wave height without waves: a slip, after which
 * the run is of another case than intended.  A key may stay if the key it needs is given, even if only to say
 * that it is off: `--set boundary.inflow=none` turns a case into its twin.  Intervals of tables that are not
 * written may stay as well, since a command line may ask for these tables. */
#ifndef FL_SCENE_UNUSED_KEYS_H
#define FL_SCENE_UNUSED_KEYS_H
#include "base/err.h"
#include "scene/scene.h"

/* Check the column `needs` of the key table, in sections without names.
 * Returns 0, or -1 with FL_INPUT and the line of the first key without effect. */
int fl_scene_check_unused(const fl_scene *scene, fl_err *err);

#endif
