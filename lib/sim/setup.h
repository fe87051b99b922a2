/* SPDX-License-Identifier: GPL-3.0-or-later */
/* setup.h -- builds a world from a scene, an ice field and a structure. */
#ifndef FL_SIM_SETUP_H
#define FL_SIM_SETUP_H
#include "world/world.h"

/* Build everything from what was read.  field and surface are read once and stay the caller's.
 *   surface  NULL for a scene without structure
 * -1 with FL_INPUT (a body without a volume where one is needed, mass not positive), FL_SYSTEM or
 * FL_NUMERIC. */
int fl_world_make(fl_world *w, const fl_scene *scene, const fl_ice_field *field, const fl_surface *surface,
                  fl_err *err);

/* The same where another field than that of the ice comes in: scene->boundary.inflow = file.  Where
 * floes come in both fields are borrowed until fl_world_free(). */
int fl_world_make_with_inflow(fl_world *w, const fl_scene *scene, const fl_ice_field *field,
                              const fl_ice_field *feed, const fl_surface *surface, fl_err *err);

void fl_world_free(fl_world *w);

/* -1 with FL_INPUT where the centre of a floe is behind a rigid wall, from where none comes back but with the
 * energy of a push as long. */
int fl_world_check_walls(const fl_world *w, fl_err *err);

#endif
