/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction at one place: an elastic spring that remembers, and Coulomb's limit. */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include "geom/vec3.h"

/* What a place remembers from step to step. */
typedef struct {
    fl_vec3 force; /* elastic part of the tangential force on A, world axes [N] */
    double k;      /* tangential stiffness it was built with              [N/m] */
} fl_slip;

/* One step of friction; returns the tangential force on A and renews *s.
 *
 * 1. The remembered force is turned about n by the mean spin of the pair, laid into the tangent plane and
 *    given back its length: it rolls with the contact.
 * 2. Where the stiffness has fallen the force falls with it (Thornton, J. Appl. Mech. 64 (1997) 363): kept,
 *    it would hold more energy than was put in.  Where it has risen the force stays: F -= k v dt is
 *    incremental.
 * 3. F -= k v dt, limited to mu |F_n|: beyond, the spring keeps the force of sliding.
 * 4. While it sticks a damping force -g v is added, the sum again limited.
 *
 *   n       unit normal, from B to A
 *   v       velocity of A's point against B's [m/s]; its normal part is dropped
 *   twist   mean angular velocity of the pair about n [rad/s]
 *   dt      [s]
 *   k       tangential stiffness now [N/m]; 0 gives no force
 *   g       tangential damping [N s/m]
 *   limit   mu |F_n| >= 0 [N] */
fl_vec3 fl_tangent_force(fl_slip *s, fl_vec3 n, fl_vec3 v, double twist, double dt, double k, double g,
                         double limit);

/* Energy held by the spring, F^2 / 2k [J]. */
static inline double fl_tangent_energy(const fl_slip *s)
{
    return s->k > 0.0 ? 0.5 * v3_norm2(s->force) / s->k : 0.0;
}

#endif
