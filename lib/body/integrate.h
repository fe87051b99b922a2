/* SPDX-License-Identifier: GPL-3.0-or-later */
/* integrate.h -- time integration of rigid bodies: kick, drift, kick.
 *
 * Translation is velocity Verlet.  Rotation carries the angular momentum L in the world and a quaternion; a
 * torque kicks L exactly, and the free rotation between kicks is split into exact rotations,
 *     H = |L|^2/(2 I1) + (1/I0 - 1/I1) L0^2/2 + (1/I2 - 1/I1) L2^2/2,
 * as axis 0 for dt/2, symmetric top (I1 everywhere, I2 about axis 2) for dt, axis 0 for dt/2.
 * Time-reversible, symplectic, order 2; L is untouched by the drift, so it is conserved to rounding. Source:
 * Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840, in the variant that joins a symmetric
 * top and one rotation.
 *
 * A body with added mass M_a, a diagonal matrix in its own axes, that goes with u = v - U through water of
 * velocity U has the momentum P = R (m + M_a) R^T u, and the water turns it (Munk's moment):
 *     dP/dt = F,   dL/dt = T + P x u,   H = 1/2 P.u + H_turn(L).
 * While it does not turn P and u stay, so that part has the exact flow x += h v, L += h P x u; half of it,
 * the rotation above with P and L kept, then the other half is order 2, time-reversible and symplectic. P and
 * x x P + L (in water at rest) are conserved to rounding whatever the step.  Source: Lamb, Hydrodynamics
 * (1932), art. 124.  Seen from where the water flows, turning M_a takes the work 1/2 U.(M_a' - M_a) U out of
 * it or puts it in; it goes to carried[i]. */
#ifndef FL_BODY_INTEGRATE_H
#define FL_BODY_INTEGRATE_H
#include "body/body.h"
#include "geom/sym3.h"

/* v += h f/m (by the momentum, with added mass), L += h t of body i < n, but for what is held; renews w.
 *   h  [s], half a step */
void fl_kick(fl_bodies *b, int32_t i, double h);

/* x += dt v and the rotation above of body i < total; renews the odometer, and w, which becomes the mean
 * spin of the step as v is its mean velocity: with the w of L at the end, off by dt/2 I^-1 (w x L), friction
 * would creep on what turns about no axis of its own.  fl_kick() puts in that of L again.  Where turns are
 * held, the held components of w and the free ones of L stay, by the midpoint rule.  dt [s] */
void fl_drift(fl_bodies *b, int32_t i, double dt);

/* fl_kick() by h, and then fl_drift() by dt where that is not 0, of the bodies [from, to), all of which are
 * balls, fl_body_is_free() and move, several at a time.  The state gets the bits that it gets one by one. */
void fl_kick_drift_isotropic(fl_bodies *b, int32_t from, int32_t to, double h, double dt);

/* Whether nothing holds body i, and it moves no water with it. */
static inline int fl_body_is_free(const fl_bodies *b, int32_t i)
{
    return !b->fixed_dof[i] && !b->added_mass;
}

/* Whether it is a ball besides. */
static inline int fl_body_is_free_isotropic(const fl_bodies *b, int32_t i)
{
    return b->is_isotropic[i] && fl_body_is_free(b, i);
}

/* The rotation part alone, of one body.  mean: the spin in the mean of dt, to order 2: the sum of the
 * rotations,
 *     I1^-1 L + (1/I0 - 1/I1) L0 e0 + (1/I2 - 1/I1) L2 e2,
 * where L0 e0 is the mean of begin and end, and e2 that of before and after the turn about L. */
fl_quat fl_drift_rotation(fl_quat q, fl_vec3 L, fl_vec3 invI, double dt, fl_vec3 *mean);

/* What the force and torque of now give body i: accelerations of v and w, none of what is held [m/s2],
 * [rad/s2].  What turns without a torque is left out: w x L and, with added mass, P x u. */
void fl_body_accelerations(const fl_bodies *b, int32_t i, fl_vec3 *a, fl_vec3 *turn);

/* How a body yields to impulses, world axes: what is not held of it, with the water that moves along. */
typedef struct {
    fl_sym3 linear;  /* velocity for an impulse      [1/kg]     */
    fl_sym3 angular; /* and spin for an angular one  [1/(kg m2)] */
} fl_mobility;

/* Of body i; none of what others move. */
fl_mobility fl_body_mobility(const fl_bodies *b, int32_t i);

/* What an impulse along n gives to the speed of its centre along that [1/kg]. */
static inline double fl_body_mobility_along(const fl_bodies *b, int32_t i, fl_vec3 n)
{
    const fl_mobility e = fl_body_mobility(b, i);
    return v3_dot(n, s3_mul(e.linear, n));
}

/* u.M^-1 u for the impulse u = (along, moment): what it gives to the speed in its own direction. */
static inline double fl_mobility_along(const fl_mobility *e, fl_vec3 along, fl_vec3 moment)
{
    return v3_dot(along, s3_mul(e->linear, along)) + v3_dot(moment, s3_mul(e->angular, moment));
}

/* Make v and L obey what is held of body i: held components of v and of the angular velocity w keep the given
 * values.  With S the free axes, w_free = (S^T I S)^-1 S^T (L - I w_held), L = I w; with added mass so P and
 * v.
 * The impulse that this takes works at the held velocity; that work goes to held[i]. */
void fl_body_apply_fixed_dof(fl_bodies *b, int32_t i, fl_vec3 v_held, fl_vec3 w_held);

#endif
