/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_setup.h -- builds one floe of a world from its record in an ice field. */
#ifndef FL_SIM_FLOE_SETUP_H
#define FL_SIM_FLOE_SETUP_H
#include "world/world.h"

/* Put floe k of a field into place i, whoever was there before: at the field's own pose, at rest in the
 * books. -1 as fl_world_make(). */
int fl_world_place_floe(fl_world *w, int32_t i, const fl_ice_field *field, int32_t k, fl_err *err);

/* Fails with the file, the line of the record and the id of the k-th floe of the field: "FILE:LINE: body ID: what". */
int fl_fail_floe(const fl_world *w, const fl_ice_field *field, int32_t k, fl_err *err, const char *what);

#endif
