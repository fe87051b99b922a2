/* SPDX-License-Identifier: GPL-3.0-or-later */
/* damping.h -- from a coefficient of restitution to the damping of a contact, for three laws.
 * Below FL_RESTITUTION_LEAST the closures diverge; smaller values are taken as that. */
#ifndef FL_LAW_DAMPING_H
#define FL_LAW_DAMPING_H

#define FL_RESTITUTION_LEAST 0.01

/* Hunt-Crossley, F = k s^n (1 + chi s'): D = chi v_impact is the root of D (1 + e) = ln[(1 + D)/(1 - e D)],
 * for every exponent, stiffness, mass and number of places.  0 for e >= 1. */
double fl_damping_crossley(double e);

/* Linear, F = k s + 2 zeta sqrt(M k) s', the contact ending when F reaches 0: zeta of restitution e.
 * Source: Schwager & Poeschel, Granular Matter 9 (2007) 465. */
double fl_damping_linear(double e);
/* The restitution that zeta gives; the inverse of the above. */
double fl_damping_linear_e(double zeta);

/* Tsuji, F = k s^(3/2) + alpha sqrt(M k) s^(1/4) s', never pulling: alpha of restitution e, by the fit of
 * Thornton, Cummins & Cleary, Powder Technology 233 (2013) 30; within 0.2 %. */
double fl_damping_tsuji(double e);

#endif
