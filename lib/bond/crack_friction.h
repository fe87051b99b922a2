/* SPDX-License-Identifier: GPL-3.0-or-later */
/* crack_friction.h -- friction of a closed crack: the law of law/tangent.h for the face as a whole.
 *
 * The pressures p_k = w_k A k_n (1 - c) <-s_n> of the points of bond.h give load, centre and shape,
 *     N = sum p,   x_c = sum p x/N,   Theta = sum p t t^T/N,   t = (x - x_c) x m,
 * which for an even pressure on a rectangle are exact. Limit: mu N. Slip is the change of s_t at x_c, spin that
 * of the angle between the half sides of either body about m, both in the frame of the face, which turns with the
 * two. The wrench acts midway between the sides at x_c.
 *
 * The stiffness is k = k_s A/2 min(1, r^2/(rho^2 + x_c^2)), r^2 = (a^2 + b^2)/3 that of the whole face, so that
 * friction is at no time stiffer than the shear of the bond was: the law has up to 1.97 k in slip and 1.97 k rho^2
 * in spin, and x_c is measured from the middle of the face. Theta sums over 9 points; of a face that is pressed at
 * a rim the moments are those of these points.
 *
 * Error of steady motion on a square, even pressure: 2.3 %; a limit for each point by itself, as damaged points
 * have it before the face has failed, gives 0.79 of the moment of pure spin. */
#ifndef FL_BOND_CRACK_FRICTION_H
#define FL_BOND_CRACK_FRICTION_H
#include "bond/bond.h"
#include "law/tangent.h"

/* Separation of a face, as in fl_bond: of the centre, and its change along a and b; in the frame m, ta, tb. */
typedef struct {
    double s[3], su[3], sv[3];
} fl_face_separation;

/* Force on i in the frame (no part along m), couple about m on i, and where they act, in half sides. */
typedef struct {
    fl_vec3 force;
    double couple, along_a, along_b;
} fl_crack_wrench;

/* The springs of a face whose points have just failed: those of its points together.  force, couple: friction on i
 * and about m, in the frame; energy: what the points store [J]. */
void fl_crack_friction_begin(fl_bond *c, fl_vec3 force, double couple, double energy);

/* Advances the springs from `before` to `now` under the pressures p[FL_BOND_POINTS] [N], and sets
 * c->friction_spring_energy. */
fl_crack_wrench fl_crack_friction_step(fl_bond *c, const double *p, const fl_face_separation *before,
                                       const fl_face_separation *now);

#endif
