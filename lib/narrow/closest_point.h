/* SPDX-License-Identifier: GPL-3.0-or-later */
/* closest_point.h -- closest points of simple shapes: point and convex polyhedron, face, segment, truncated
 * cone.  The distance is signed where the shape has an inside. */
#ifndef FL_NARROW_CLOSEST_POINT_H
#define FL_NARROW_CLOSEST_POINT_H
#include "narrow/closest_kernel.h"

/* Point x and a convex polyhedron: the Euclidean distance outside, the largest n_f.x - c_f (<= 0) inside,
 * which is continuous through zero.  Points, segments and flat polygons have no inside: d >= 0. */
fl_closest_point fl_closest_on_poly(const fl_poly *p, fl_vec3 x);

/* Point x and one face of a polyhedron, as a flat polygon: d >= 0, n from p to x (the normal of the face
 * where d is rounding). */
fl_closest_point fl_closest_on_face(const fl_poly *p, int32_t f, fl_vec3 x);

/* Point x and the border of that face. */
fl_closest_point fl_closest_on_face_border(const fl_poly *p, int32_t f, fl_vec3 x);

/* Point x and the segment from a to b. */
fl_closest_point fl_closest_on_segment(fl_vec3 a, fl_vec3 b, fl_vec3 x);

/* Point x and the solid truncated cone between the disc of radius r0 about the origin and the disc of radius
 * r1 about (0, 0, h); h > 0.  On the axis the direction is x; of equal distances the smaller z is taken. */
fl_closest_point fl_closest_on_cone(double r0, double r1, double h, fl_vec3 x);

#endif
