/* SPDX-License-Identifier: GPL-3.0-or-later */
/* raster.h -- a surface seen along an axis: which part each pixel shows, how far off, how lit. */
#ifndef FL_GEOM_RASTER_H
#define FL_GEOM_RASTER_H
#include "geom/surface.h"

/* Right and up in the picture are coordinates (0 x, 1 y, 2 z); the eye is far out along `toward`, on its
 * positive side for side = 1, on its negative one for side = -1. */
typedef struct {
    int right, up, toward, side;
} fl_view_axes;

enum { FL_RASTER_NONE = -1, FL_RASTER_LINE = -2 };

typedef struct {
    fl_view_axes axes;
    int32_t w, h;
    double u0, v0, pixel; /* lower left corner, side of a pixel [m] */
    int32_t *part;        /* [w h] row 0 lowest: part seen, FL_RASTER_NONE, or FL_RASTER_LINE on an edge */
    double *depth;        /* [w h] coordinate along the view, nearer is larger [m]; -INFINITY for nothing */
    float *light;         /* [w h] 0 .. 1: cosine between the normal and the light, either side of a face */
} fl_raster;

/* An empty picture.  -1 with FL_SYSTEM. */
int fl_raster_start(fl_raster *r, fl_view_axes axes, int32_t w, int32_t h, double u0, double v0, double pixel,
                    fl_err *err);

/* Draw the triangles of s: each pixel shows the nearest one over its centre, whatever their order, and
 * triangles that pass through each other show where they do; of those in one place to a millionth of a pixel
 * the first one is seen.  Cones are not drawn: give them facets. */
void fl_raster_fill(fl_raster *r, const fl_surface *s);

/* Then draw edges where they are not hidden: rims, edges of more than two triangles, and those at which the
 * surface bends by more than `bend` degrees.  An edge is seen where nothing is nearer by more than two
 * pixels.  -1 with FL_SYSTEM. */
int fl_raster_lines(fl_raster *r, const fl_surface *s, double bend, fl_err *err);

void fl_raster_free(fl_raster *r); /* accepts a zeroed struct, leaves one */

#endif
