/* SPDX-License-Identifier: GPL-3.0-or-later */
/* held_sphere_kernel.h -- a sphere with fixed degrees of freedom, by value, for integrate.h and devices.
 *
 *   hold   FL_DOF_X | ...: fixed directions of the world
 *   turn   1/I, I: moment of inertia [1/(kg m2)], [kg m2]
 * Fixed components of v and w keep given values; L = I w.  The impulses of the constraints do work. */
#ifndef FL_BODY_HELD_SPHERE_KERNEL_H
#define FL_BODY_HELD_SPHERE_KERNEL_H
#include "body/fixed_dof.h"
#include "body/sphere_motion_kernel.h"
#include "geom/sym3.h"

enum { FL_DOF_TURNS = FL_DOF_RX | FL_DOF_RY | FL_DOF_RZ };

/* The components of own along free directions, and of held along fixed ones. */
static inline fl_vec3 fl_held_components(unsigned hold, fl_vec3 held, fl_vec3 own)
{
    return v3(hold & FL_DOF_X ? held.x : own.x, hold & FL_DOF_Y ? held.y : own.y,
              hold & FL_DOF_Z ? held.z : own.z);
}

/* Angular velocity, or its change, at the angular momentum L. */
static inline fl_vec3 fl_held_spin(unsigned hold, fl_vec3 held, fl_vec3 L, double turn)
{
    return fl_held_components(hold / FL_DOF_RX, held, v3_scale(turn, L));
}

/* L of w, as fl_body_set_spin(). */
static inline fl_vec3 fl_held_momentum(fl_vec3 w, double I)
{
    const fl_mat3 R = q_matrix(q_one());
    const fl_vec3 s = m3_tmul(R, w);
    return m3_mul(R, v3(I * s.x, I * s.y, I * s.z));
}

/* Work of a constraint impulse of rotation.  It acts about fixed axes only; other components are rounding. */
static inline double fl_held_turning_work(unsigned hold, fl_vec3 impulse, fl_vec3 w)
{
    return (hold & FL_DOF_RX ? impulse.x * w.x : 0.0) + (hold & FL_DOF_RY ? impulse.y * w.y : 0.0) +
           (hold & FL_DOF_RZ ? impulse.z * w.z : 0.0);
}

/* The motion a with the fixed components of v and w; *work grows by that of the impulses [J].
 *   m, heave   mass, and added mass along the vertical, 0 without [kg] */
static inline fl_sphere_motion fl_held_motion(fl_sphere_motion a, unsigned hold, fl_vec3 v, fl_vec3 w,
                                              double m, double heave, double turn, double I, double *work)
{
    fl_sphere_motion q = a;
    q.v = fl_held_components(hold, v, a.v);
    if (hold & FL_DOF_TURNS) q.w = fl_held_spin(hold, w, a.L, turn), q.L = fl_held_momentum(q.w, I);
    const fl_vec3 change = v3_sub(q.v, a.v);
    const double rising = heave > 0.0 ? heave * change.z * v.z : 0.0;
    *work += m * v3_dot(change, v) + rising + fl_held_turning_work(hold, v3_sub(q.L, a.L), w);
    return q;
}

/* Attitude after dt of a sphere with fixed rotations, by the midpoint rule; L and w of *a follow. */
static inline fl_quat fl_held_turned(fl_quat q, fl_sphere_motion *a, unsigned hold, double turn, double I,
                                     double dt, double *work)
{
    const fl_vec3 w = a->w, L = a->L;
    const fl_vec3 middle = fl_held_spin(hold, w, L, turn);
    const fl_quat to = fl_quat_renormalised(q_mul(fl_quat_turn(v3_scale(dt, middle)), q));
    a->w = fl_held_spin(hold, w, L, turn), a->L = fl_held_momentum(a->w, I);
    *work += fl_held_turning_work(hold, v3_sub(a->L, L), w);
    return to;
}

/* Inverse inertia along the free axes, 0 along the fixed ones: the bits of the factorisation that integrate.c
 * makes for other bodies. */
static inline fl_sym3 fl_held_inverse_inertia(unsigned hold, double I)
{
    const double root = sqrt(I), each = 1.0 / root / root;
    fl_sym3 e;
    e.xx = hold & FL_DOF_RX ? 0.0 : each, e.yy = hold & FL_DOF_RY ? 0.0 : each;
    e.zz = hold & FL_DOF_RZ ? 0.0 : each, e.xy = e.xz = e.yz = 0.0;
    return e;
}

#endif
