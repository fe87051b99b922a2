/* SPDX-License-Identifier: GPL-3.0-or-later */
/* closed_surface.h -- a closed surface of triangles: whether it is closed, its volume, and what lies inside.
 * */
#ifndef FL_BLOCK_CLOSED_SURFACE_H
#define FL_BLOCK_CLOSED_SURFACE_H
#include "geom/surface.h"

/* -1 with FL_INPUT unless every edge has two triangles, once in each direction, between corners with the same
 * numbers, and the volume is above 0. */
int fl_closed_surface_check(const fl_part *p, fl_err *err);

/* Volume [m3]. */
double fl_closed_surface_volume(const fl_part *p);

/* True if x is inside: the solid angle of the triangles is 4 pi there and 0 outside.  x must not be on it.
 * Source: Van Oosterom & Strackee, IEEE Trans. Biomed. Eng. 30 (1983) 125. */
int fl_closed_surface_contains(const fl_part *p, fl_vec3 x);

/* Adds the prism over the polygon xy[n], counter-clockwise, between z0 < z1. */
int fl_closed_surface_prism(fl_part *p, int32_t n, const double (*xy)[2], double z0, double z1, fl_err *err);

#endif
