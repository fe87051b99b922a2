/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_check_zones.h -- checks of [zones] against the rest of a scene. */
#ifndef FL_SCENE_SCENE_CHECK_ZONES_H
#define FL_SCENE_SCENE_CHECK_ZONES_H
#include "scene/scene.h"

/* -1 with FL_INPUT: no size, a strength that is missing, what deformable blocks do not have. */
int fl_scene_check_zones(const fl_scene *s, fl_err *err);

#endif
