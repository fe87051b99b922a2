/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_check_failure.h -- checks of [failure], [bond] and [joint] against the other sections: what breaks
 * needs, and what it excludes.  Each returns 0, or -1 with FL_INPUT. */
#ifndef FL_SCENE_SCENE_CHECK_FAILURE_H
#define FL_SCENE_SCENE_CHECK_FAILURE_H
#include "scene/scene.h"

int fl_scene_check_failure(const fl_scene *s, fl_err *err);

/* What crushing by speed excludes. */
int fl_scene_check_crushing_rate(const fl_scene *s, fl_err *err);

int fl_scene_check_bonds(const fl_scene *s, fl_err *err);

#endif
