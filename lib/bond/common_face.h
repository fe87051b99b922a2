/* SPDX-License-Identifier: GPL-3.0-or-later */
/* common_face.h -- where two bodies lie on one another: the common part of two of their faces. */
#ifndef FL_BOND_COMMON_FACE_H
#define FL_BOND_COMMON_FACE_H
#include "geom/poly.h"

typedef struct {
    fl_vec3 x;    /* its centroid                                    [m]  */
    fl_vec3 n;    /* unit normal, from the first body to the second       */
    fl_vec3 a, b; /* half sides of the rectangle with its second moments, along its principal axes, a no
                   * longer than b [m]: the square of a is 3 I/A */
    double area;  /* [m2] */
} fl_common_face;

/* The largest common part of a face of p and one of q that look at each other, both within `near` of x, q
 * moved by way: normals that are opposite to 1e-6, planes no farther apart than 1e-6 of the sizes.
 *   p, q   in the world; x, way [m]
 * 1, or 0 when there is none, or -1 with FL_SYSTEM. */
int fl_common_face_find(const fl_poly *p, const fl_poly *q, fl_vec3 way, fl_vec3 x, fl_common_face *out,
                        fl_err *err);

/* The same of a disc: area, centre and normal as they are given. */
void fl_common_face_disc(double area, fl_vec3 x, fl_vec3 n, fl_common_face *out);

#endif
