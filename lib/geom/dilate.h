/* SPDX-License-Identifier: GPL-3.0-or-later */
/* dilate.h -- a convex polyhedron swept by a ball: the Minkowski sum P + B(r). */
#ifndef FL_GEOM_DILATE_H
#define FL_GEOM_DILATE_H
#include "geom/poly.h"

/* Volume of P + B(r), by Steiner's formula
 *     V(r) = V + A r + (r^2 / 2) sum_e l_e t_e + (4/3) pi r^3
 * where l_e is the length of edge e and t_e the angle between the outward normals of its two faces.
 *
 *   p   point, segment, flat polygon or solid, as fl_poly_make() leaves it   [m]
 *   r   dilation radius, r >= 0                                             [m]
 * Returns V(r) [m^3].  Cannot fail.  Source: Schneider, Convex Bodies (2014), ch. 4. */
double fl_dilate_volume(const fl_poly *p, double r);

/* Surface area of P + B(r), the derivative of V(r):
 *     A(r) = A + r sum_e l_e t_e + 4 pi r^2   [m^2]
 * A flat polygon counts on both sides.  Arguments as above.  Cannot fail. */
double fl_dilate_area(const fl_poly *p, double r);

#endif
