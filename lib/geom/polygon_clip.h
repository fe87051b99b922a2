/* SPDX-License-Identifier: GPL-3.0-or-later */
/* polygon_clip.h -- the common part of two convex polygons, and the moments of a polygon.
 *
 * Sutherland & Hodgman, Comm. ACM 17 (1974) 32: one polygon is cut by the half-planes of the other's sides.
 * No square root; a side of no length cuts nothing. */
#ifndef FL_GEOM_POLYGON_CLIP_H
#define FL_GEOM_POLYGON_CLIP_H
#include "geom/polygon.h"

/* The part of v[n] where dx y - dy x <= dx y0 - dy x0 is false, that is to the left of the line through o
 * along d; in place, with room for n + 1.  Returns the number of corners left, 0 if none. */
int32_t fl_polygon_keep_left(int32_t n, fl_vec2 *v, fl_vec2 o, fl_vec2 d);

/* The common part of a[n] and b[m], both counter-clockwise; out has room for n + m corners and may be a.
 * Returns the number of its corners, 0 if there is none. */
int32_t fl_polygon_common(int32_t n, const fl_vec2 *a, int32_t m, const fl_vec2 *b, fl_vec2 *out);

typedef struct {
    double area;       /* positive counter-clockwise [m2] */
    fl_vec2 centre;    /* centroid; v[0] without area [m] */
    double xx, xy, yy; /* second moments about the centroid, int x x dA ... [m4] */
} fl_polygon_moments;
fl_polygon_moments fl_polygon_moments_of(int32_t n, const fl_vec2 *v);

#endif
