/* SPDX-License-Identifier: GPL-3.0-or-later */
/* material.h -- stiffness of a contact from the elastic constants and radii of the two bodies. */
#ifndef FL_LAW_MATERIAL_H
#define FL_LAW_MATERIAL_H

typedef struct {
    double young; /* [Pa]; INFINITY for a rigid body */
    double poisson;
} fl_elastic_constants;

/* Effective modulus, 1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b [Pa].  Equation (5) of the manual. */
double fl_material_modulus(fl_elastic_constants a, fl_elastic_constants b);

/* Effective radius, 1/R* = 1/R_a + 1/R_b [m].  A radius of 0 means a flat partner, such as the structure. */
double fl_material_radius(double ra, double rb);

/* Stiffness of a flat punch [N/m], 2 E* beta sqrt(A/pi), beta = 1.02.
 *   modulus  E* [Pa]
 *   area     A, of the contact [m2]
 * Source: equation (25) of the manual; King, Int. J. Solids Struct. 23 (1987) 1657, for beta. */
double fl_material_punch(double modulus, double area);

/* Hertz stiffness, F = kappa d^(3/2): kappa = (4/3) E* sqrt(R*) [N/m^1.5].  Johnson 1985, eq. 4.23. */
double fl_material_hertz(double modulus, double radius);

#endif
