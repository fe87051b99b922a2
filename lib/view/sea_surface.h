/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sea_surface.h -- the waves of a scene as heights over a square, water/wave.h: eta = sum a cos(k s -
 * omega t + phi). */
#ifndef FL_VIEW_SEA_SURFACE_H
#define FL_VIEW_SEA_SURFACE_H
#include "scene/scene.h"
#include "water/wave.h"

enum { FL_SEA_SIDE = 128 };

/* Heights about still water of FL_SEA_SIDE x FL_SEA_SIDE points over side x side from x0, y0 [m]. */
typedef struct {
    const float *height; /* NULL: still water */
    float x0, y0, side;
} fl_sea_surface;

/* The waves of a scene; *has: 0 where it has none.  -1 with FL_SYSTEM. */
int fl_sea_of_scene(fl_waves *w, const fl_scene *scene, int *has, fl_err *err);

/* Heights at time t; they fade to 0 at the rim of the square. */
void fl_sea_heights(const fl_waves *w, double t, const fl_sea_surface *where, float *height);

#endif
