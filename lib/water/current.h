/* SPDX-License-Identifier: GPL-3.0-or-later */
/* current.h -- how fast the water (or the air) goes by.  Uniform: one velocity everywhere. */
#ifndef FL_WATER_CURRENT_H
#define FL_WATER_CURRENT_H
#include "geom/vec3.h"

typedef struct {
    fl_vec3 velocity; /* [m/s] */
} fl_current;

/* Velocity at the point x at time t [m/s].
 *   x       world position                       [m]
 *   depth   of that point below still water      [m]
 *   t       [s] */
fl_vec3 fl_current_at(const fl_current *c, fl_vec3 x, double depth, double t);

#endif
