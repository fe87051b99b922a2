/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crack_friction.h -- friction of a closed crack: the law of law/tangent.h for the face as a whole.
 *
 * The pressures p_k = w_k A k_n (1 - c) <-s_n> of the points of bond.h give load, centre and shape,
 *     N = sum p,   x_c = sum p x/N,   Theta = sum p t t^T/N,   t = (x - x_c) x m,
 * which for an even pressure on a rectangle are exact. Limit: mu N. Slip is the change of s_t at x_c, spin
 * that of the angle between the half sides of either body about m, both in the frame of the face, which turns
 * with the two. The wrench acts midway between the sides at x_c.
 *
 * The stiffness is k = k_s A min(1, r^2/(rho^2 + x_c^2)), r^2 = (a^2 + b^2)/3 that of the whole face, so that
 * slip of a crack is as stiff as the shear of its bond was, and the force does not jump as the last point
 * fails. The law has up to 1.97 k in slip where the face also spins, which stays below k_n A of the bond.
 * Theta sums over 9 points; of a face that is pressed at a rim the moments are those of these points.
 *
 * Error of steady motion on a square, even pressure: 2.3 %; a limit for each point by itself, as damaged
 * points have it before the face has failed, gives 0.79 of the moment of pure spin. */
#ifndef FL_BOND_CRACK_FRICTION_H
#define FL_BOND_CRACK_FRICTION_H
#include "law/tangent.h"

/* Separation of a face, as in fl_bond: of the centre, and its change along a and b, in the frame. */
typedef struct {
    double s[3], su[3], sv[3];
} fl_face_separation;

typedef struct {
    double half_a, half_b; /* half sides [m] */
    double shear;          /* k_s A [N/m] */
    double friction;       /* mu */
} fl_crack_face;

/* Sums of the pressures of the points: N, and of it times the coordinates in half sides. */
typedef struct {
    double sum, a, b, aa, ab, bb;
} fl_crack_pressure;

/* Springs of friction, z of law/tangent.h, in the frame; k 0: they have not been used. */
typedef struct {
    double y, z, moment, k, k_turn; /* [N], [N], [N m], [N/m], [N m] */
    double energy;                  /* [J] */
} fl_crack_springs;

/* Force on i in the frame (no part along m), couple about m on i, and where they act, in half sides. */
typedef struct {
    fl_vec3 force;
    double couple, along_a, along_b;
} fl_crack_wrench;

/* Advances the springs from `before` to `now`. A face that is not pressed forgets them. */
fl_crack_wrench fl_crack_friction_step(fl_crack_springs *springs, const fl_crack_face *face,
                                       const fl_crack_pressure *p, const fl_face_separation *before,
                                       const fl_face_separation *now);

#endif
