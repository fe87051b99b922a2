/* SPDX-License-Identifier: GPL-3.0-or-later */
/* submerged.h -- submerged part of a body: the result of buoyancy.h and prism_buoyancy.h. */
#ifndef FL_WATER_SUBMERGED_H
#define FL_WATER_SUBMERGED_H
#include "geom/vec3.h"

/* In body axes, about the body's origin. */
typedef struct {
    double volume;          /* V [m^3] */
    fl_vec3 centre;         /* centre of buoyancy x_B; 0 when dry [m] */
    double wetted_area;     /* wetted surface [m^2] */
    double waterplane_area; /* section with the water plane [m^2] */
} fl_submerged;

#endif
