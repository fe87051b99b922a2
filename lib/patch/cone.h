/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone.h -- patch points of a dilated convex core on a solid truncated cone, exact: the cone is no
 * polyhedron.
 *
 * The cone C is smooth or a rim everywhere and has no features of its own.  The signed distance d(x) from C,
 * evaluated on the surface of the core A, gives the whole potential of patch_law.h, as over a plane.  With
 * s = R - d, U is the sum over A of
 *     face F     int m(c) s^4 dA,     c = -n_F.n(x),  n = grad d,  m = (4 c^2 - 3)^2, 0 beyond 30 degrees
 *     edge       w L (256/315) sqrt(2 R) int s^(9/2) dl
 *     vertex     w L (2 pi/5) R s^5
 * A rim, or the point of a cone, that is pressed into a face counts in the first term: int s^4 over its
 * strip, sqrt(2 R s) wide, is the edge term of patch_law.h.  Force and couple are the gradient,
 *     f = int (4 m s^3 n + m' s^4 K n_F) dA at x,     couple int m' s^4 n_F x n dA,
 * where K = grad n is the curvature of the surface at distance d: e e / rho around the axis, times the radial
 * component of n, and 1/d in the profile plane at rims.  The domain belongs to A, so no border moves.
 *
 * Integration: a face is cut into rows across the projected axis.  On a row the height z along the axis is
 * constant, so the part within R of C is |y| < sqrt(P(z)^2 - H^2), P the profile of C dilated by R, H the
 * distance of the row from the axis.  Both directions use Gauss rules.  They are cut at corners of F and
 * where side becomes rim, and their nodes are clustered where s ends. */
#ifndef FL_PATCH_CONE_H
#define FL_PATCH_CONE_H
#include "patch/cone_profile.h"
#include "patch/patch_types.h"

/* Support function of the cone: the largest n.x over it [m]. */
double fl_cone_support(const fl_truncated_cone *c, fl_vec3 n);

/* Adds all patch points of core a, dilation radius ra, to w->point and w->couple, after a has been
 * transformed to the frame of the cone by fl_patch_points_transform().  -1 when memory runs out. */
int fl_cone_evaluate(fl_patch_points *w, const fl_poly *a, const fl_truncated_cone *c, double ra);

#endif
