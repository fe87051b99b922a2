/* SPDX-License-Identifier: GPL-3.0-or-later */
/* added_mass.h -- added mass and added inertia of a body, in its principal axes.
 *
 * The axis across is the one nearest to the vertical at the start: for a flat floe, the axis through its
 * thickness. The two other axes lie in its plane. Both quantities are set once, for the body afloat at rest.
 * They do not change with submergence, and remain when the body leaves the water. */
#ifndef FL_WATER_ADDED_MASS_H
#define FL_WATER_ADDED_MASS_H
#include "geom/poly.h"

/* Value of the scene's word `auto`: a number below 0. */
#define FL_ADDED_MASS_AUTO -1.0

/* Added mass per axis, factor * displaced [kg]. Auto is
 *     0.1 displaced                in the plane of a floe; published values for surge are 0.1 to 0.15
 *     4/3 rho a^3, a^2 = A/pi      across it: half of the 8/3 rho a^3 of a disc, since one side is wet
 *     1/2 displaced                for a sphere or capsule: that of a sphere
 *   outer      outer shape, body axes; A is its projected area along the axis across [m]
 *   up         e_z in body axes
 *   displaced  mass of the displaced water at rest [kg]
 *   density    rho [kg/m3]
 *   factor      factors, or FL_ADDED_MASS_AUTO: of the two axes in the plane, in their order, then across
 * Source: Lamb, Hydrodynamics (1932), art. 92, 102. */
fl_vec3 fl_added_mass(const fl_poly *outer, fl_vec3 up, double displaced, double density, fl_vec3 factor);

/* Added moments of inertia per axis, factor * own [kg m2]. Auto is 8/45 rho a^5, half that of a disc, about
 * axes in the plane. It is 0 about the axis across, and for a sphere or capsule. Source: as above. */
fl_vec3 fl_added_inertia(const fl_poly *outer, fl_vec3 up, fl_vec3 own, double density, fl_vec3 factor);

#endif
