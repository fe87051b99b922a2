/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_law.h -- the contact law `patch`: the potential of two dilated convex cores that overlap.
 *
 * R is the sum of the dilation radii, d(x, B) the distance of a point x of one core from the other core B,
 * and s = R - d its overlap.  The potential is
 *
 *     W = c sqrt(U),     c = E* beta / sqrt(pi),     U = sum over the features of both cores of
 *
 *     face       1/2 m int s^4 dA       over each face of the other core
 *     edge       w L (256/315) sqrt(2 rho) int s^(9/2) dl
 *     vertex     w L (2 pi/5) rho s^5
 *
 *     W, U   energy [J], its integral [m6]
 *     E*     contact modulus [Pa]
 *     beta   shape factor of a polygonal punch, FL_PATCH_BETA;  L = 32/45 / beta^2
 *     m      (1 - 4 sin^2)^2 of the angle between the two faces, 0 from 30 degrees on
 *     rho    dilation radius of the core that has the feature, of the other core where that is 0 [m]
 *     w      1, and less for edges and vertices that are nearly flat: FL_PATCH_EDGE_WEIGHT, .._CORNER_WEIGHT
 *
 * Force and torque on A are the negative gradient of W over the pose of A.
 *
 * The three terms are one integral int s^4 dA, over the contact of a flat, of a cylinder and of a sphere of
 * radius rho.  Properties:
 *   - s is the distance from a whole convex body, so no contact has to be classified.  The gradient of W is
 *     continuous from vertex to edge to face and over every border.
 *   - A face has the stiffness of a flat punch, K = 2 E* beta sqrt(A/pi), eq. (25) of the manual.  Its
 *     rocking stiffness is 9/8 of a punch's: (3/4) a^2 K instead of (2/3) a^2 K.  Only the power 4 gives the
 *     first with the root, and it nearly gives the second.
 *   - A vertex on a face is Hertz' contact, exactly: (8/15) E* sqrt(rho) s^(5/2).
 *   - Every pressure is positive, and more contact never lowers the energy.
 *   - U is a sum over pieces of surface: a wall of 2 triangles and one of 20 000 give the same.
 *
 * Limits:
 *   - Long line contacts are too soft, as sqrt(length): at 1 m length, 50 mm radius and 1 mm overlap 3 times
 *     softer than a rigid strip on a half-space.
 *   - Two crossing edges and two vertices count from both sides: up to 1.7 and 1.4 times as stiff as Hertz.
 *   - A face that leaves the rim of another one has a jump of the tangential force, s/(4 sqrt A) of the
 *     normal force: beyond the rim its strip, sqrt(2 R s) wide, belongs to the edge. */
#ifndef FL_PATCH_PATCH_LAW_H
#define FL_PATCH_PATCH_LAW_H
#include "patch/patch_types.h"

#define FL_PATCH_RIM_WIDTH 0.1 /* width over R of the rim of a face, in which its weight fades to 0 */
#define FL_PATCH_BETA 1.02     /* beta: circle 1, square 1.012, triangle 1.034 */
#define FL_PATCH_ROUND_FACTOR (32.0 / 45.0 / (FL_PATCH_BETA * FL_PATCH_BETA)) /* L */
#define FL_PATCH_EDGE_WEIGHT (1.0 / FL_POLY_BLUNT_EDGE)     /* w = bend times this [1/rad], at most 1 */
#define FL_PATCH_CORNER_WEIGHT (1.0 / FL_POLY_BLUNT_CORNER) /* w = defect times this [1/sr], at most 1 */

/* rho: radius of a feature of a core of dilation radius r against one of radius `other` [m]. */
static inline double fl_patch_feature_radius(double r, double other) { return r > 0.0 ? r : other; }

/* Adds the vertex term of U.
 *   own      core of vertex v;  other: dilation radius of the other core [m]
 *   n        unit vector from the nearest point of the other core to the vertex
 *   overlap  s > 0 [m]
 * Returns -1 when memory runs out. */
int fl_patch_points_add_vertex(fl_patch_points *w, const fl_patch_core *own, double other, int32_t v,
                               fl_vec3 n, double overlap);

#endif
