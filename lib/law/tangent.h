/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tangent.h -- friction of one contact: an elastic spring along it and one about its normal, which remember,
 * and Coulomb's limit for the two together. */
#ifndef FL_LAW_TANGENT_H
#define FL_LAW_TANGENT_H
#include <math.h>
#include "base/wide.h"
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

/* What a step of friction leaves, and what it does to A. */
typedef struct {
    fl_slip slip;
    fl_vec3 force;
    double moment; /* about n */
} fl_rubbed;

/* Of a force f and a moment m the part that the limit allows. */
FL_WIDE_PART double fl_tangent_part(fl_rubbing c, fl_vec3 f, double m)
{
    const double arm = c.arm > 0.0 ? m / c.arm : 0.0, size2 = v3_norm2(f) + arm * arm;
    return size2 > c.limit * c.limit ? c.limit / sqrt(size2) : 1.0;
}

/* One step of friction, without a branch or a pointer, so that it goes into loops over lanes.
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
FL_WIDE_PART fl_rubbed fl_tangent_rub(fl_slip s, fl_rubbing c, fl_vec3 v, double spin, double twist,
                                      double dt)
{
    const double before = v3_norm2(s.force), k = c.k, turning = k * c.arm * c.arm;
    const fl_vec3 rolled = v3_madd(s.force, twist * dt, v3_cross(c.n, s.force));
    const fl_vec3 laid = v3_madd(rolled, -v3_dot(rolled, c.n), c.n);
    const double after = v3_norm2(laid), length = after > 0.0 ? sqrt(before / after) : 1.0;
    const double fall = k < s.k ? k / s.k : 1.0, fall_turn = turning < s.k_turn ? turning / s.k_turn : 1.0;
    const fl_vec3 along = v3_madd(v, -v3_dot(v, c.n), c.n);
    const fl_vec3 f = v3_madd(v3_scale(fall, v3_scale(length, laid)), -k * dt, along);
    const double m = fall_turn * s.moment - turning * dt * spin, part = fl_tangent_part(c, f, m);
    const fl_slip kept = {v3_scale(part, f), k, part * m, turning};
    const double g = part < 1.0 ? 0.0 : c.g;
    const fl_vec3 damped = v3_madd(kept.force, -g, along);
    const double twisted = kept.moment - g * c.arm * c.arm * spin, most = fl_tangent_part(c, damped, twisted),
                 left = part < 1.0 ? 1.0 : most;
    return (fl_rubbed){kept, v3_scale(left, damped), left * twisted};
}

/* The stiffness was taken for another all the time, and is `by` times as large.  Where it has fallen
 * meanwhile force and moment have fallen with what it was taken for, and now with what it is.  Where it has
 * risen the springs have not been unloaded: they keep their forces where they are stiffer; where they are
 * softer that would make energy, and they keep what they hold. */
static inline void fl_tangent_remeasured(fl_slip *s, double by, int fell)
{
    const double left = fell ? by : by < 1.0 ? sqrt(by) : 1.0;
    s->k *= by;
    s->k_turn *= by;
    s->force = v3_scale(left, s->force);
    s->moment *= left;
}

/* Energy held by the springs, F^2 / 2k + M^2 / 2 k_turn [J]. */
FL_WIDE_PART double fl_tangent_energy(fl_slip s)
{
    return (s.k > 0.0 ? 0.5 * v3_norm2(s.force) / s.k : 0.0) +
           (s.k_turn > 0.0 ? 0.5 * s.moment * s.moment / s.k_turn : 0.0);
}

#endif
