/* SPDX-License-Identifier: GPL-3.0-or-later */
/* face_integral.h -- face term of the law `patch`: 1/2 m int s^4 dA of a face of one core over a face of the
 * other (patch_law.h), as patch points.
 *
 * Face F of the own core is projected along the normal n_f of face f onto the plane of f and clipped to
 * s > 0.  There s = R - h is linear, h the height of F over that plane.  The intersection with f is not
 * built.  The integral over a polygon is a sum over pieces p0 p1 of its border,
 *     int g dA = sum (p0 x p1) int_0^1 dt int_0^1 rho g(o + rho (p(t) - o)) drho,
 * with an origin o near by.  The border consists of the parts of the sides of F inside f and the parts of the
 * sides of f inside F.  The integral over rho is closed; over t a Gauss rule of three points is exact for
 * s^4, s^3 and the first moments.  Which part of a side of f is inside F follows from its crossings with the
 * sides of F, so the border closes to rounding even where sides are parallel.
 *
 * Where the border is F's own rim it moves with F.  This adds two terms to the gradient, the rim forces,
 * which have no energy of their own. */
#ifndef FL_PATCH_FACE_INTEGRAL_H
#define FL_PATCH_FACE_INTEGRAL_H
#include "patch/patch_types.h"

#define FL_FACE_PAIR_COSINE 0.86602540378443865 /* cos 30 deg: faces at a larger angle have no face term */

/* Adds the points of face F of `own` over face f of `other`.
 *   R            reach [m]
 *   prism_depth  how far below f its prism extends [m]
 *   rim          width of the border of f in which the weight falls linearly to 0; less where f is small [m].
 *                Without it W would have a kink where a face leaves the rim of an equal one.
 * -1 when memory runs out. */
int fl_face_integral_over_face(fl_patch_points *w, const fl_patch_core *own, int32_t F,
                               const fl_patch_core *other, int32_t f, double R, double prism_depth,
                               double rim);

/* Adds the points of face F of `own` over the plane z = 0, with weight m instead of m/2: the plane has no
 * term over F. */
int fl_face_integral_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t F, double R);

#endif
