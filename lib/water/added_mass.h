/* SPDX-License-Identifier: GPL-3.0-or-later */
/* added_mass.h -- the water that a body moves along with it, as mass and inertia in the body's own axes (those of
 * its principal moments).  Across is the axis that is nearest to the vertical where the body starts, of a
 * floe that lies flat the one through its thickness; the two others are in its plane.
 *
 * Both are set once, for the body afloat at rest: they do not change as it dips, and stay when it is lifted
 * out. */
#ifndef FL_WATER_ADDED_MASS_H
#define FL_WATER_ADDED_MASS_H
#include "geom/poly.h"

/* A number of the scene below 0, its word auto. */
#define FL_ADDED_MASS_AUTO -1.0

/* Added mass per axis, asked * displaced [kg].  Auto is
 *     0.1 displaced                in the plane of a floe, of ranges 0.1 to 0.15 for surge
 *     4/3 rho a^3, a^2 = A/pi      across it: half of a disc's 8/3 rho a^3, for one side is wet
 *     1/2 displaced                of what is round: a sphere's
 *   outer      the outer shape in the body's axes; A is the area of its shadow along the axis across [m]
 *   up         e_z in the body's axes
 *   displaced  mass of the water that the body displaces at rest [kg]
 *   density    rho [kg/m3]
 *   asked      factors, or FL_ADDED_MASS_AUTO: of the two in the plane in their order, and across
 * Source: Lamb, Hydrodynamics (1932), art. 92, 102. */
fl_vec3 fl_added_mass(const fl_poly *outer, fl_vec3 up, double displaced, double density, fl_vec3 asked);

/* Added moments of inertia per axis, asked * own [kg m2].  Auto is 8/45 rho a^5, half of a disc's, about axes
 * in the plane, 0 about that across and of what is round.  Source: as above. */
fl_vec3 fl_added_inertia(const fl_poly *outer, fl_vec3 up, fl_vec3 own, double density, fl_vec3 asked);

#endif
