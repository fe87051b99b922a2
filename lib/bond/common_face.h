/* SPDX-License-Identifier: GPL-3.0-or-later */
/* common_face.h -- the common part of two faces in contact, as a rectangle with its second moments. */
#ifndef FL_BOND_COMMON_FACE_H
#define FL_BOND_COMMON_FACE_H
#include "geom/poly.h"

typedef struct {
    fl_vec3 x; /* centroid [m] */
    fl_vec3 n; /* unit normal, from the first body to the second */
    /* half sides of the rectangle with its second moments, along the principal axes, a no longer than b [m]:
     * a^2 = 3 I/A */
    fl_vec3 a, b;
    double area; /* [m2] */
} fl_common_face;

/* Finds the largest common part of a face of p and an opposite one of q, q moved by way, both through x.
 * Normals are opposite to 1e-6, planes no farther than 1e-6 of the smaller size from x.
 *   p, q   in the world; x, way [m]
 * Returns 1, 0 if there is none, or -1 with FL_SYSTEM. */
int fl_common_face_find(const fl_poly *p, const fl_poly *q, fl_vec3 way, fl_vec3 x, fl_common_face *out,
                        fl_err *err);

/* The same for a disc of given area, centre and normal. */
void fl_common_face_disc(double area, fl_vec3 x, fl_vec3 n, fl_common_face *out);

#endif
