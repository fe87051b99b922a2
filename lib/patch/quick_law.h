/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_law.h -- the contact law `quick`: the potential of two dilated convex cores, from terms of low
 * cost.
 *
 * As `patch` (patch_law.h) it takes W = c sqrt(U) with the same c and the same measure int s^4 of the overlap
 * s = R - d, d the exact distance from the other core, so stiffness and material are those of `patch`.  U is
 *
 *     face      m/2C int_P s^4 dP                 over each pair of faces, once from either side
 *     vertex    w L (2 pi/5) rho s^5
 *     edge      v w L (256/315) sqrt(2 rho) sum_i l_i o_i s_i^(9/2)       points i fixed on the edge
 *     crossing  w w' L (2 pi/5) sqrt(rho rho') s^5 g(S^2)/S t(z) t(z')    of each pair of edges
 *
 *     C     -n_j.n_k of the two faces;  m = (4 C^2 - 3)^2, 0 from 30 degrees on
 *     P     face j along n_k on the plane of k, cut by the inset face k (quick_shape.h) and by 0 < s < R: a
 *           part below the plane of k is beyond the other side of the body
 *     w     weight of a blunt edge or corner, as in `patch`;  rho, L as there
 *     l_i   Gauss weights of four points in each part of the edge, at most FL_QUICK_SEGMENT rho long [m]
 *     v     share of the edge that its faces do not bear: product of 1 - f h(A/A_0) h(D/0.6 R)
 *           over the pairs of a face of the edge; f = 1 - h of the sine of the angle of the two faces, 1
 *           below FL_QUICK_FLAT and 0 from FL_QUICK_TILTED on; A area of the common part on face j,
 *           A_0 = min(R sqrt(a), a/2) of the smaller face a, D = int z^4/int z^3 over the part within 2R,
 *           z = s + R: at least 2R/3 where the faces touch
 *     o_i   1 over a face.  Beyond its rim o = H + (1 - H) (1 - g(S^2)) t(z): H falls to 0 where the
 *           direction from the nearest point leaves the normals of all faces by 32 degrees, 1 - g is the
 *           share of edges that are parallel to the nearest edge.  What is left crosses, and is a term of
 *           its own.
 *     S     sine of the angle of two edges;  g = h((S^2 - FL_QUICK_ALONG^2)/FL_QUICK_PARALLEL)
 *     z     distance of a foot from the nearer end of its edge;  t = h(z/min(0.3 R/S, l/2)); S = 1 at points
 *     h(x)  x^3 (10 - 15x + 6x^2) between 0 and 1
 *
 * Force and torque are the exact gradient.  With the motion u(x) of A a point has dU = -dU/ds n.u, and a face
 *     (m/C) [-4 int s^3 n_k.u dP - sum over sides of f_k on the border int s^4 q.u dl]
 *         - dm/dC I4/C turn.(n_j x n_k):
 * it is an integral over face j, dA = dP/C, so 1/C is not differentiated.
 *
 * Properties: a vertex on a face and two edges that cross at any angle are Hertz' contact; a face is the flat
 * punch; W does not depend on which body is A.  The force is continuous but where two parallel rims pass each
 * other at the inset: there it jumps along the face by s/(8 sqrt A) of the normal force on an area A.
 *
 * Limits: those of `patch`, and: a face tilted by 0.5 to 6 degrees, which bears on a strip no wider than
 * some insets, has as little as 0.6 of the energy that `patch` gives it.  A point on an edge stands for a
 * quarter of a part, so a line contact that is shorter is uneven by some percent; edges that cross over a
 * face count beside the face. */
#ifndef FL_PATCH_QUICK_LAW_H
#define FL_PATCH_QUICK_LAW_H
#include "narrow/penetration.h"
#include "patch/quick_rows.h"

/* Sums over the terms, in the frame of B and about its origin; over dW/dU they are forces and moments. */
typedef struct {
    double u, ddu;      /* U, and its second derivative with respect to all s  [m6], [m4] */
    double reach;       /* dU/dR                                                     [m5] */
    double overlap;     /* the largest                                                [m] */
    fl_wrench gradient; /* minus the gradient of U, on A                       [m5], [m6] */
    double pressure;    /* sum of e, the force of all terms along their normals      [m5] */
    fl_vec3 direction;  /* sum of e n                                                [m5] */
    fl_vec3 moment;     /* sum of e x, x the middle of the overlap                   [m6] */
    fl_sym3 second;     /* sum of e x x^T                                            [m7] */
} fl_quick_sums;

/* Evaluates the listed terms of two cores.
 *     M, o   pose of A in the frame of B
 *     deep   penetration of the cores in that frame, depth 0 where they do not overlap.  Cores that penetrate
 *            by D are evaluated as if A were shifted by D n, with R + D.
 * The list must be valid for the shifted pose.  -1 when memory runs out. */
int fl_quick_evaluate(fl_quick_scratch *w, const fl_quick_shape *a, const fl_quick_shape *b, double ra,
                      double rb, fl_mat3 M, fl_vec3 o, const fl_penetration *deep, const fl_quick_list *l,
                      fl_quick_sums *sums);

#endif
