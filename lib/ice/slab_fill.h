/* SPDX-License-Identifier: GPL-3.0-or-later */
/* slab_fill.h -- the solid part of a slab that a sheet of equal spheres in layers stands for.
 *
 * n spheres of diameter D in `layers` layers, each over an area a of the sheet, stand for a slab of thickness
 * h.  Its solid part is
 *     phi = layers (pi D^3/6)/(a h),     a = sqrt(3)/2 D^2 in triangular layers, D^2 in square ones:
 * 0.741 for hcp with h = layers x 0.8165 D, 0.605 for layers straight above each other with h = layers x D.
 * Spheres with 1/phi of their mass, buoyancy and drag have weight, draft and heave stiffness of the slab.
 *
 * The layers are read from the heights of the centres, and the kind of layer from the neighbours of the
 * lowest sphere nearest to the middle: more than four at the distance D in its layer, and it is triangular. */
#ifndef FL_ICE_SLAB_FILL_H
#define FL_ICE_SLAB_FILL_H
#include <stdint.h>
#include "base/err.h"
#include "geom/vec3.h"

/* Sets *phi from the centres x[n] and the radius of all of them, thickness h > 0 [m].  -1 with FL_INPUT if the
 * spheres do not lie in layers or phi is not within 0.2 and 1.1, or FL_SYSTEM. */
int fl_slab_fill(int32_t n, const fl_vec3 *x, double radius, double h, double *phi, fl_err *err);

#endif
