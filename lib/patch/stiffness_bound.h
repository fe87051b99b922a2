/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stiffness_bound.h -- stiffness of the contacts of one body: an upper bound of the squared frequency omega^2
 * that they give it.
 *
 * Motions are scaled by the mass matrix M of the body: g = M^-1/2 (force, torque) for a unit force at a
 * contact point.  The stiffness of springs k is the 6 by 6 matrix K = sum k g g^T [1/s2]; omega^2 is its
 * largest eigenvalue. */
#ifndef FL_PATCH_STIFFNESS_BOUND_H
#define FL_PATCH_STIFFNESS_BOUND_H
#include "body/body.h"

typedef struct {
    double a[6][8]; /* K; the last two numbers of each row are 0 [1/s2] */
} fl_stiffness;

/* Springs k along n at offsets r from one point: sums of k n n^T [N/m], of k (r x n) n^T [N], its rows those
 * of r x n, and of k (r x n) (r x n)^T [N m].  The last number of each row is 0. */
typedef struct {
    double linear[3][4], coupling[3][4], angular[3][4];
} fl_spring_sums;

/* K += scale times the springs q.  R: rotation from their axes to the world's; a: offset of their point from
 * the centre of body i, world axes.  Does nothing for a fixed body. */
void fl_stiffness_add_springs(fl_stiffness *s, const fl_bodies *b, int32_t i, double scale,
                              const fl_spring_sums *q, fl_mat3 R, fl_vec3 a);

/* K += k g g^T for the force f and torque t on body i, world axes; k may be negative; k f^2 in [N/m].  Does
 * nothing for a fixed body. */
void fl_stiffness_add_force(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 f, fl_vec3 t);

/* Adds springs k in both directions across n, at the offset r from the centre of body i: sticking friction.
 */
void fl_stiffness_add_tangential(fl_stiffness *s, const fl_bodies *b, int32_t i, double k, fl_vec3 n,
                                 fl_vec3 r);

/* |K^4|^(1/4) in the Frobenius norm [1/s2]: at least the largest eigenvalue, at most 6^(1/8) = 1.25 times it.
 */
double fl_stiffness_bound(const fl_stiffness *s);

/* Largest omega^2 of a sphere with one contact point [1/s2].  One spring acts along the normal and, where it
 * sticks, two at right angles across it; they do not couple, so the result is the larger of two values.
 *   along, across   stiffness of the springs [N/m]
 *   arm             from the centre of body i, not fixed, to the point [m]
 *   turning         stiffness of rolling resistance, which adds to the springs across [N m] */
static inline double fl_stiffness_of_point(const fl_bodies *b, int32_t i, double along, double across,
                                           double arm, double turning)
{
    const double one = along * b->invm[i],
                 two = across * (b->invm[i] + arm * arm / b->I[i].x) + turning / b->I[i].x;
    return one > two ? one : two;
}

#endif
