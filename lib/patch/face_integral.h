/* SPDX-License-Identifier: GPL-3.0-or-later */
/* face_integral.h -- the places of faces: 1/2 int s^4 dA of one face over another (patch_points.h).
 *
 * Face F is projected along the normal n_f of f onto the plane of f and cut with s > 0; there s = R - h, h
 * the height of F over that plane, is linear.  What of it lies over f is not cut out: the integral over a
 * polygon is a sum over its border,
 *     int g dA = sum over pieces p0 p1 of (p0 x p1) int_0^1 dt int_0^1 rho g(o + rho (p(t) - o)) drho,
 * o an origin near by, and the border is the parts of the sides of F that lie in f and the parts of the sides
 * of f that lie in F.  In rho the integrals are closed, in t Gauss' three points are exact for s^4, s^3 and
 * the first moments.  What of a side of f lies in F is told by where the sides of F cross it, so that the
 * border closes to rounding whatever is parallel to what.  Where F's own rim is the border, moving F moves
 * it: two more terms of the gradient, which have no energy of their own. */
#ifndef FL_PATCH_FACE_INTEGRAL_H
#define FL_PATCH_FACE_INTEGRAL_H
#include "patch/patch_types.h"

#define FL_FACE_PAIR_COSINE 0.86602540378443865 /* of the angle between faces beyond which there is no area */

/* The rim of f fades out linearly over `rim` (less where f is small): a face that leaves the rim of an equal
 * one all at once would bend W. Face F of `own` over face f of `other`.  -1 when memory runs out. */
int fl_face_integral_over_face(fl_patch_points *w, const fl_patch_core *own, int32_t F,
                               const fl_patch_core *other, int32_t f, double R, double behind, double rim);

/* Face F of `own` over the plane z = 0, whole: no other half of it is seen from the plane. */
int fl_face_integral_over_plane(fl_patch_points *w, const fl_patch_core *own, int32_t F, double R);

#endif
