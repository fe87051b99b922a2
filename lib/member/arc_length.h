/* SPDX-License-Identifier: GPL-3.0-or-later */
/* arc_length.h -- the load factor of a step from a constraint on the displacements it leads to.
 *
 * After a step the displacements are d = a + lambda b, a without load and b = c2 dt2 P0/m from the load.
 *     total         |d| = l, counted from the start (Ye & Xu 2024)
 *     increment     |d - d_1| = l, counted from the last point; ends where the loaded displacement turns
 *     displacement  P0.d = l |P0|, the displacement that does work on the load
 *     load          lambda is given
 * total and increment lead to  bb x2 + 2 ab x + (aa - l2) = 0,  of which the root is taken that has the
 * larger d.d_old; both come from q = -(ab + sign(ab) sqrt(ab2 - bb (aa - l2))) as q/bb and (aa - l2)/q,
 * which cancel nothing. Where there is no root, lambda is that of the equilibrium of the loaded freedoms,
 * F.P0/P0.P0. */
#ifndef FL_MEMBER_ARC_LENGTH_H
#define FL_MEMBER_ARC_LENGTH_H

enum fl_arc_constraint { FL_ARC_TOTAL, FL_ARC_INCREMENT, FL_ARC_DISPLACEMENT, FL_ARC_LOAD };

/* Root x of bb x2 + 2 ab x + cc = 0: the larger one where db > 0, the smaller one where db < 0, else that
 * nearer to x0.  0, or 1 where there is none; *x is left then. */
int fl_arc_root(double bb, double ab, double cc, double db, double x0, double *x);

/* Greatest or least value of a parabola through three points (s, y), s ascending and y[1] beyond both or
 * equal.
 *   at   where it is */
double fl_arc_parabola(const double s[3], const double y[3], double *at);

/* Value of the polynomial of n <= 4 points at s (Lagrange). */
double fl_arc_polynomial(int n, const double *s, const double *y, double at);

/* The same extreme from a cubic through four points, found from the parabola through the last three of them.
 * */
double fl_arc_cubic(const double s[4], const double y[4], double *at);

/* Integral of x dy from s[1] to s[2], x and y parabolas in s through three points. */
double fl_arc_work(const double s[3], const double x[3], const double y[3]);

#endif
