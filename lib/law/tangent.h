/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction of one contact: an elastic spring along it and one about its normal, which remember,
 * and Coulomb's limit for the two together. */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include <math.h>
#include "geom/vec3.h"

/* What a contact remembers from step to step. */
typedef struct {
    fl_vec3 force; /* elastic part of the tangential force on A, world axes [N] */
    double k;      /* tangential stiffness it was built with              [N/m] */
    double moment; /* elastic part of the moment on A about the normal    [N m] */
    double k_turn; /* stiffness that was built with                   [N m/rad] */
} fl_slip;

/* A contact as friction sees it. */
typedef struct {
    fl_vec3 n;    /* unit normal, from B to A */
    double k;     /* tangential stiffness now [N/m]; 0 gives no force */
    double g;     /* tangential damping [N s/m]      */
    double limit; /* mu |F_n| >= 0 [N]               */
    double arm;   /* root mean square distance of the pressure from its centre [m]; 0 for a point */
} fl_rubbing;

/* One step of friction; returns the tangential force on A, sets *moment, the one about n, and renews *s.
 *
 * 1. The remembered force is turned about n by the mean spin of the pair, laid into the tangent plane and
 *    given back its length: it rolls with the contact.
 * 2. Where the stiffness has fallen force and moment fall with it (Thornton, J. Appl. Mech. 64 (1997) 363):
 *    kept, they would hold more energy than was put in.  Where it has risen they stay: F -= k v dt is
 *    incremental, and so is M -= k arm^2 w dt.
 * 3. The two are limited together, (F/limit)^2 + (M/(limit arm))^2 <= 1: beyond, the springs keep what
 *    sliding leaves.  Source of the ellipse: Goyal, Ruina & Papadopoulos, Wear 143 (1991) 307.
 * 4. While it sticks damping -g v, -g arm^2 w is added, the sum again limited.
 *
 *   v       velocity of A's point against B's [m/s]; its normal part is dropped
 *   spin    angular velocity of A less that of B about n [rad/s]
 *   twist   mean angular velocity of the pair about n [rad/s]
 *   dt      [s] */
fl_vec3 fl_tangent_force(fl_slip *s, const fl_rubbing *c, fl_vec3 v, double spin, double twist, double dt,
                         double *moment);

/* The stiffness was taken for another all the time, and is `by` times as large: the springs have not been
 * unloaded.  They keep their forces where they are stiffer; where they are softer that would make energy, and
 * they keep what they hold. */
static inline void fl_tangent_remeasured(fl_slip *s, double by)
{
    s->k *= by;
    s->k_turn *= by;
    if (!(by < 1.0)) return;
    s->force = v3_scale(sqrt(by), s->force);
    s->moment *= sqrt(by);
}

/* Energy held by the springs, F^2 / 2k + M^2 / 2 k_turn [J]. */
static inline double fl_tangent_energy(const fl_slip *s)
{
    return (s->k > 0.0 ? 0.5 * v3_norm2(s->force) / s->k : 0.0) +
           (s->k_turn > 0.0 ? 0.5 * s->moment * s->moment / s->k_turn : 0.0);
}

#endif
