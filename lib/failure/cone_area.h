/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cone_area.h -- the area vector of the side of a truncated cone inside a convex body.
 *
 *     S = int n dA,     n = (cos phi, sin phi, -r')/sqrt(1 + r'^2),    r' = (r1 - r0)/h
 *
 * The planes of the body bound each generator, phi constant, to one part of it, from the largest of their
 * lower to the least of their upper bounds.  Where the bounding plane changes, the line of two planes meets
 * the cone: A cos phi + B sin phi = C.  Between these angles S is summed over all arcs that are inside:
 *   a cylinder   in closed form, as the length inside is a + b cos phi + c sin phi
 *   a cone       by 8 Gauss points, on parts where the radius at a plane varies by less than 5/3 about its
 *                mean: relative error 1e-9
 * The end discs do not count. */
#ifndef FL_FAILURE_CONE_AREA_H
#define FL_FAILURE_CONE_AREA_H
#include "failure/half_spaces.h"
#include "structure/structure.h"

/* S of what faces `facing`, of all if that is 0, in the frame of the cone.
 *   area   out: its area; or NULL [m2] */
fl_vec3 fl_cone_area_vector(const fl_half_spaces *a, const fl_piece *cone, fl_vec3 facing, double *area);

#endif
