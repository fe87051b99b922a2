/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_check_motion.h -- checks of how the structure moves: [structure], [part NAME], [mode NAME], members.
 * Each returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
#ifndef FL_SCENE_SCENE_CHECK_MOTION_H
#define FL_SCENE_SCENE_CHECK_MOTION_H
#include "scene/scene.h"

/* Prescribed and free motion of the structure and of its parts. */
int fl_scene_check_motions(const fl_scene *s, fl_err *err);

/* A structure of members has no other motion, and no other pieces. */
int fl_scene_check_members(const fl_scene *s, fl_err *err);

/* Each part with a mode gets a section of its own. */
int fl_scene_check_modes(fl_scene *s, fl_err *err);

#endif
