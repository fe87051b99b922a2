/* SPDX-License-Identifier: GPL-3.0-or-later */
/* integrate.h -- time integration of rigid bodies: kick, drift, kick.
 *
 * Translation is velocity Verlet. Rotation carries the angular momentum L in world axes and a quaternion. A
 * torque kicks L exactly. The free rotation between kicks is split into exact rotations,
 *     H = |L|^2/(2 I1) + (1/I0 - 1/I1) L0^2/2 + (1/I2 - 1/I1) L2^2/2,
 * as axis 0 for dt/2, symmetric top (I1 everywhere, I2 about axis 2) for dt, axis 0 for dt/2. The scheme is
 * time-reversible, symplectic and of order 2. The drift leaves L unchanged, so L is conserved to rounding.
 * Source: Dullweber, Leimkuhler & McLachlan, J. Chem. Phys. 107 (1997) 5840, in the variant that joins a
 * symmetric top and one rotation.
 *
 * A body with added mass M_a (diagonal in its own axes) moves with u = v - U through water of velocity U. Its
 * momentum is P = R (m + M_a) R^T u, and the water exerts Munk's moment:
 *     dP/dt = F,   dL/dt = T + P x u,   H = 1/2 P.u + H_turn(L).
 * Without rotation P and u are constant, so that part has the exact flow x += h v, L += h P x u. Half of it,
 * the rotation above at constant P and L, then the other half is time-reversible, symplectic and of order 2.
 * P and x x P + L (in water at rest) are conserved to rounding for any step. Source: Lamb, Hydrodynamics
 * (1932), art. 124. In the frame of the flow, turning M_a exchanges the work 1/2 U.(M_a' - M_a) U;
 * flow_work[i] sums it. */
#ifndef FL_BODY_INTEGRATE_H
#define FL_BODY_INTEGRATE_H
#include "body/body.h"
#include "geom/sym3.h"

/* v += h f/m (with added mass by the momentum), L += h t of body i < n, subject to its constraints; updates
 * w.
 *   h   half a step [s] */
void fl_kick(fl_bodies *b, int32_t i, double h);

/* x += dt v and the rotation above, of body i < total; updates the odometer and w. w becomes the mean angular
 * velocity of the step, as v is its mean velocity. The w of L at the end differs by dt/2 I^-1 (w x L) and
 * would make friction creep on a body that turns about no principal axis. fl_kick() sets w from L again. With
 * fixed rotations, the fixed components of w and the free ones of L stay constant, by the midpoint rule.
 *   dt   [s] */
void fl_drift(fl_bodies *b, int32_t i, double dt);

/* fl_kick() by h, then fl_drift() by dt if dt is not 0, of the bodies [from, to), four at a time. All are
 * free and isotropic, and i < n. The state gets the same bits as one by one. */
void fl_kick_drift_isotropic(fl_bodies *b, int32_t from, int32_t to, double h, double dt);

/* fl_drift() of such bodies. */
void fl_drift_isotropic(fl_bodies *b, int32_t from, int32_t to, double dt);

/* True if body i has neither constraints nor added mass. */
static inline int fl_body_is_free(const fl_bodies *b, int32_t i)
{
    return !b->fixed_dof[i] && !b->added_mass && !b->heave_mass;
}

/* True if body i is free and isotropic. */
static inline int fl_body_is_free_isotropic(const fl_bodies *b, int32_t i)
{
    return b->is_isotropic[i] && fl_body_is_free(b, i);
}

/* The rotation alone, of one body. mean: the mean angular velocity over dt to order 2, the sum over the
 * rotations
 *     I1^-1 L + (1/I0 - 1/I1) L0 e0 + (1/I2 - 1/I1) L2 e2,
 * where L0 e0 is the mean of begin and end, and e2 that of before and after the rotation about L. */
fl_quat fl_drift_rotation(fl_quat q, fl_vec3 L, fl_vec3 invI, double dt, fl_vec3 *mean);

/* Accelerations of v and w of body i by the present force and torque; 0 along fixed directions [m/s2],
 * [rad/s2]. Torque-free terms are left out: w x L and, with added mass, P x u. */
void fl_body_accelerations(const fl_bodies *b, int32_t i, fl_vec3 *a, fl_vec3 *turn);

/* Inverse mass matrices of a body, world axes: its response to impulses along its free directions, added mass
 * included. */
typedef struct {
    fl_sym3 linear;  /* velocity per impulse [1/kg] */
    fl_sym3 angular; /* angular velocity per angular impulse [1/(kg m2)] */
} fl_mobility;

/* Mobility of body i; zero for a piece of the structure. */
fl_mobility fl_body_mobility(const fl_bodies *b, int32_t i);

/* Velocity change of the centre along n per impulse along n [1/kg]. */
static inline double fl_body_mobility_along(const fl_bodies *b, int32_t i, fl_vec3 n)
{
    const fl_mobility e = fl_body_mobility(b, i);
    return v3_dot(n, s3_mul(e.linear, n));
}

/* u.M^-1 u of the impulse u = (along, moment): the velocity change in its own direction. */
static inline double fl_mobility_along(const fl_mobility *e, fl_vec3 along, fl_vec3 moment)
{
    return v3_dot(along, s3_mul(e->linear, along)) + v3_dot(moment, s3_mul(e->angular, moment));
}

/* Makes v and L obey the constraints of body i: the fixed components of v and w keep the given values. With S
 * the free axes,
 *     w_free = (S^T I S)^-1 S^T (L - I w_held),   L = I w,
 * and with added mass likewise for P and v. The constraint impulse does work at the fixed velocity, which is
 * added to work_of_constraints[i]. */
void fl_body_apply_fixed_dof(fl_bodies *b, int32_t i, fl_vec3 v_held, fl_vec3 w_held);

#endif
