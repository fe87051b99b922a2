/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_setup.h -- makes the deformable blocks of a world from [zones] of the scene.
 *
 * The outer shape of a body is divided (zone_mesh.h).  Its body stays in the list as a pose that follows
 * the nodes: mean place, mean velocity, mean rotation.  Sides of the model, [zones] min_side and
 * max_side, are the boundary triangles in the planes of the bounding box of all deformable blocks. */
#ifndef FL_SIM_ZONE_SETUP_H
#define FL_SIM_ZONE_SETUP_H
#include "scene/ice_field.h"
#include "world/world.h"

/* Before the bonds are made.  -1 with FL_SYSTEM, or FL_INPUT: a group without bodies, a block thinner
 * than two zones, strengths that are missing. */
int fl_zones_make(fl_world *w, const fl_ice_field *field, fl_err *err);

/* After the bonds: joints with a deformable side. */
int fl_zones_join(fl_world *w, const fl_ice_field *field, fl_err *err);

void fl_zones_free(fl_zone_state *z);

#endif
