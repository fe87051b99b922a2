/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet.h -- triangulates polygons, boxes and round solids. */
#ifndef FL_GEOM_FACET_H
#define FL_GEOM_FACET_H
#include "geom/surface.h"

enum { FL_FACET_CORNERS = 10000 };

/* Appends the solid c as triangles: n inscribed facets, closed ends, outward normals.  The corners lie on the
 * circles, the first of each in a direction at right angles to the axis (+y for an upright one).  The volume
 * is that of c times (n / 2 pi) sin(2 pi / n).
 *   n   3 .. FL_FACET_CORNERS
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_facet_cone(fl_part *p, const fl_cone *c, int32_t n, fl_err *err);

/* Appends the box lo .. hi as 8 vertices and 12 triangles.  Returns 0, or -1 with FL_SYSTEM. */
int fl_facet_box(fl_part *p, fl_vec3 lo, fl_vec3 hi, fl_err *err);

/* Appends the polygon loop[0 .. n) of p's vertices as at most n - 2 triangles of the same winding.  Corners
 * equal to the one before are skipped; fewer than three corners give nothing.  A convex quadrilateral is
 * split along its shorter diagonal if its corners lie within 1e-6 of that diagonal from one plane, else along
 * the diagonal with the larger smallest angle; a tie goes to the diagonal through the lowest index.  Concave
 * and longer polygons are triangulated by ear clipping in the plane of their area vector.  If the polygon
 * intersects itself and no ear is left, the rest is cut corner by corner.
 *   n   at most FL_FACET_CORNERS (the time is n times the number of concave corners)
 * Returns 0, or -1 with FL_SYSTEM.  Source: Meisters, Am. Math. Monthly 82 (1975) 648, polygons have ears. */
int fl_facet_polygon(fl_part *p, int32_t n, const int32_t *loop, fl_err *err);

#endif
