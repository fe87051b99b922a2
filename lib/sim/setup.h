/* SPDX-License-Identifier: GPL-3.0-or-later */
/* setup.h -- build a world from a scene, an ice field and a structure; free it; check it. */
#ifndef FL_SIM_SETUP_H
#define FL_SIM_SETUP_H
#include "world/world.h"

/* Build a world.  field and surface are read once and stay the caller's.
 *   surface  NULL for a scene without structure
 * -1 with FL_INPUT (a body without a volume where one is needed, a mass that is not positive), FL_SYSTEM or
 * FL_NUMERIC. */
int fl_world_make(fl_world *w, const fl_scene *scene, const fl_ice_field *field, const fl_surface *surface,
                  fl_err *err);

/* The same where the inflow is another field than the ice: boundary.inflow = file, or the structure one of
 * members, whose surface is that of fl_member_motion_surface().  With an inflow both fields are borrowed
 * until fl_world_free(), and members always. */
int fl_world_make_with_inflow(fl_world *w, const fl_scene *scene, const fl_ice_field *field,
                              const fl_ice_field *feed, const fl_surface *surface,
                              const fl_member_model *members, fl_err *err);

void fl_world_free(fl_world *w);

/* -1 with FL_INPUT if the centre of a floe is behind a rigid wall: it would be pushed back with the
 * energy of that depth. */
int fl_world_check_walls(const fl_world *w, fl_err *err);

#endif
