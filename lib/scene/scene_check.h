/* SPDX-License-Identifier: GPL-3.0-or-later */
/* scene_check.h -- the keys of a scene held against one another. */
#ifndef FL_SCENE_SCENE_CHECK_H
#define FL_SCENE_SCENE_CHECK_H
#include "scene/scene.h"

/* Fill in what follows another key (state_every, energy_every, contacts_every, hash_every, bonds_every:
 * loads_every; ice_every: frames_every; until: duration), add the materials "ice" and "steel" where the
 * file does not define them (scene(5) gives their values), and refuse what cannot be run: no ice, a
 * material or group that does not exist, an empty domain, a contact pair given twice, two outputs or inputs
 * on one stream, a group driven in a direction that it leaves free, a key that bears on nothing.  May be
 * called again after fl_scene_set(). 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_scene_check(fl_scene *scene, fl_err *err);

#endif
