/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_check.h -- checks of the keys of a scene against each other. */
#ifndef FL_SCENE_SCENE_CHECK_H
#define FL_SCENE_SCENE_CHECK_H
#include "scene/scene.h"

/* Set the values that copy another key (state_every, energy_every, contacts_every, hash_every,
 * bonds_every: loads_every; ice_every: frames_every; until: duration), and add the materials "ice" and
 * "steel" if they are absent (scene(5) gives their values).  Reject a scene that cannot be run: no ice, an
 * unknown material or group, an empty domain, a contact pair given twice, two outputs or inputs on one
 * stream, a group driven in a free direction, a key without effect.  May be called again after
 * fl_scene_set(). Returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_scene_check(fl_scene *scene, fl_err *err);

#endif
