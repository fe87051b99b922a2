/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet.h -- polygons, boxes and round solids as triangles. */
#ifndef FL_GEOM_FACET_H
#define FL_GEOM_FACET_H
#include "geom/surface.h"

enum { FL_FACET_CORNERS = 10000 };

/* Append the solid c as triangles: n facets inscribed in it, ends closed, normals outward.  Corners
 * lie on the circles, the first of each in one of the directions at right angles to the axis (+y for an
 * upright one).  Its volume is that of c times (n / 2 pi) sin(2 pi / n).
 *   n   3 .. FL_FACET_CORNERS
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_facet_cone(fl_part *p, const fl_cone *c, int32_t n, fl_err *err);

/* Append the box lo .. hi as 8 vertices and 12 triangles.  Returns 0, or -1 with FL_SYSTEM. */
int fl_facet_box(fl_part *p, fl_vec3 lo, fl_vec3 hi, fl_err *err);

/* Append the polygon loop[0 .. n) of p's vertices as at most n - 2 triangles of the same winding.  Corners
 * equal to the one before are skipped, and fewer than three left give nothing.  A convex quadrilateral is
 * split along its shorter diagonal where its corners lie within 1e-6 of that diagonal from one plane, else
 * along the diagonal that leaves the larger smallest angle; a tie goes to the one through the lowest index.
 * Concave and longer polygons lose ears in the plane of their vector area; where one crosses itself and no
 * ear is left, the rest is cut off corner by corner.
 *   n   at most FL_FACET_CORNERS (the time is n times the number of concave corners)
 * Returns 0, or -1 with FL_SYSTEM.  Source: Meisters, Am. Math. Monthly 82 (1975) 648, polygons have ears. */
int fl_facet_polygon(fl_part *p, int32_t n, const int32_t *loop, fl_err *err);

#endif
