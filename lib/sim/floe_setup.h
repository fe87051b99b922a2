/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_setup.h -- build one floe of a world from its record in an ice field. */
#ifndef FL_SIM_FLOE_SETUP_H
#define FL_SIM_FLOE_SETUP_H
#include "world/world.h"

/* Build floe k of a field in place i, instead of the floe there: at the pose of the field, with works of
 * 0.  -1 as fl_world_make(). */
int fl_world_place_floe(fl_world *w, int32_t i, const fl_ice_field *field, int32_t k, fl_err *err);

/* Build a core of radius r in place i, instead of the floe there: core in the axes of the ice file, about any
 * origin; x and q are then the pose of its centre and principal axes there. Material, id and fixed
 * directions stay. -1 with FL_SYSTEM, or FL_INPUT for a shape without volume. */
int fl_world_place_shape(fl_world *w, int32_t i, const fl_poly *core, double r, fl_err *err);

/* Fail with file, line of the record and id of floe k of the field: "FILE:LINE: body ID: what". */
int fl_fail_floe(const fl_world *w, const fl_ice_field *field, int32_t k, fl_err *err, const char *what);

#endif
