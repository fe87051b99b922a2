/* SPDX-License-Identifier: GPL-3.0-or-later */
/* raster.h -- renders a surface along an axis: part, depth and light of each pixel. */
#ifndef FL_GEOM_RASTER_H
#define FL_GEOM_RASTER_H
#include "geom/surface.h"

/* right and up are coordinates (0 x, 1 y, 2 z) of the picture; the eye is far away along `toward`, on the
 * positive side for side = 1, on the negative side for side = -1. */
typedef struct {
    int right, up, toward, side;
} fl_view_axes;

enum { FL_RASTER_NONE = -1, FL_RASTER_LINE = -2 };

typedef struct {
    fl_view_axes axes;
    int32_t w, h;
    double u0, v0, pixel; /* lower left corner, side of a pixel [m] */
    int32_t *part;        /* [w h] row 0 lowest: visible part, FL_RASTER_NONE, or FL_RASTER_LINE on an edge */
    double *depth;        /* [w h] coordinate along the view, nearer is larger [m]; -INFINITY for none */
    float *light;         /* [w h] brightness 0 .. 1: cosine of normal and light, for both sides */
} fl_raster;

/* Makes an empty picture.  -1 with FL_SYSTEM. */
int fl_raster_start(fl_raster *r, fl_view_axes axes, int32_t w, int32_t h, double u0, double v0, double pixel,
                    fl_err *err);

/* Draws the triangles of s with a depth buffer: each pixel shows the nearest triangle over its centre, in any
 * order of drawing.  Of triangles within a millionth of a pixel the first is shown.  Cones are not drawn:
 * convert them to facets. */
void fl_raster_fill(fl_raster *r, const fl_surface *s);

/* Then draws visible edges: boundaries, edges of more than two triangles, and edges where the surface bends
 * by more than `bend` degrees.  An edge is visible where nothing is nearer by more than two pixels.  -1 with
 * FL_SYSTEM. */
int fl_raster_lines(fl_raster *r, const fl_surface *s, double bend, fl_err *err);

void fl_raster_free(fl_raster *r); /* accepts a zeroed struct, leaves one */

#endif
