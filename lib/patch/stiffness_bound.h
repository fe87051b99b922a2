/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stiffness_bound.h -- how stiff a contact is for one of its bodies: a bound of the square of the frequency
 * that it gives.
 *
 * Motions are measured by the mass: with g = M^-1/2 (force, torque) of a unit force at a place, the stiffness
 * of the contact is the 6 by 6 matrix K = sum k g g^T, and omega^2 is its largest eigenvalue. */
#ifndef FL_PATCH_STIFFNESS_BOUND_H
#define FL_PATCH_STIFFNESS_BOUND_H
#include "body/body.h"

typedef struct {
    double a[6][8]; /* of each row the last two numbers are 0 [1/s2] */
} fl_stiffness;

/* Springs k along n at offsets r from one point, as their sums over k n n^T, k (r x n) n^T and
 * k (r x n) (r x n)^T, rows of the second being those of r x n; of each row the last number is 0.
 * [N/m], [N], [N m] */
typedef struct {
    double linear[3][4], coupling[3][4], angular[3][4];
} fl_spring_sums;

/* K += scale times such springs in axes that R turns into the world's, about the offset a from the centre of
 * body i, world axes.  Nothing for a body that is held. */
void fl_stiffness_add_springs(fl_stiffness *s, const fl_bodies *b, int32_t i, double scale,
                              const fl_spring_sums *q, fl_mat3 R, fl_vec3 a);

/* K += k g g^T for the force f and torque t on body i; k may be negative.  f, t in world axes, k (f, t)^2 in
 * [N/m].  Nothing for a body that is held. */
void fl_stiffness_add_force(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 f, fl_vec3 t);

/* A spring k in every direction across n, at the offset r from the centre of body i: friction that sticks. */
void fl_stiffness_add_tangential(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 n,
                                 fl_vec3 r);

/* |K^4|^(1/4), Frobenius' norm: not below the largest eigenvalue, and at most 6^(1/8) = 1.25 times it. */
double fl_stiffness_bound(const fl_stiffness *s);

/* Of a sphere that touches in one point the springs are one along n and, where it sticks, two across it, at
 * right angles to each other in every way: the largest omega^2 is the larger of theirs [1/s2].  along,
 * across: their stiffness [N/m];  arm: from the centre of body i, not held, to the point [m];  turning: that
 * of what keeps it from rolling [N m], which comes to those across. */
static inline double fl_stiffness_of_point(const fl_bodies *b, int32_t i, double along, double across,
                                           double arm, double turning)
{
    const double one = along * b->invm[i],
                 two = across * (b->invm[i] + arm * arm / b->I[i].x) + turning / b->I[i].x;
    return one > two ? one : two;
}

#endif
