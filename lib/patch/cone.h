/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone.h -- the places of a dilated convex core on a solid truncated cone, which is exact: no polygon.
 *
 * The frustum C is smooth or a rim everywhere, so that it has no features of its own: what d(x), the signed
 * distance from C, says on the surface of the core A is all of the potential of patch_points.h, as over a
 * plane. With s = R - d, U is the sum over A of
 *     faces F      int m(c) s^4 dA,     c = -n_F.n(x),  n = grad d,  m = (4 c^2 - 3)^2, 0 beyond 30 degrees
 *     edges        w L (256/315) sqrt(2 R) int s^(9/2) dl
 *     vertices     w L (2 pi/5) R s^5
 * A rim or the point of a cone that presses into a face counts there: int s^4 over its strip, sqrt(2 R s)
 * wide, is what an edge has in patch_points.h.  Force and torque are the gradient,
 *     f = int (4 m s^3 n + m' s^4 K n_F) dA at x,     and the couple int m' s^4 n_F x n dA,
 * K = grad n the curvature of the surface at distance d: e e / rho round the axis, times the radial part of
 * n, and on rims 1/d the other way.  The domain is A's own, so that no border moves.
 *
 * Integrals: over a face by lines across the projected axis.  On such a line the height z along the axis is
 * one, so that what is within R of C is |y| < sqrt(P(z)^2 - H^2), P the profile of C dilated by R, H the
 * distance of the line from the axis.  Both are Gauss' rules, cut at corners of F and where side becomes rim,
 * and bunched where s ends. */
#ifndef FL_PATCH_CONE_H
#define FL_PATCH_CONE_H
#include "patch/cone_profile.h"
#include "patch/patch_types.h"

/* Largest n.x over it. */
double fl_cone_support(const fl_truncated_cone *c, fl_vec3 n);

/* Add all places of core a, radius ra, after fl_patch_points_transform() into the frame of the frustum, to
 * w->place and w->couple.  -1 when memory runs out. */
int fl_cone_evaluate(fl_patch_points *w, const fl_poly *a, const fl_truncated_cone *c, double ra);

#endif
