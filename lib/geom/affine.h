/* SPDX-License-Identifier: GPL-3.0-or-later */
/* affine.h -- affine maps that keep shapes (similarities): rotation, reflection, scaling, translation. */
#ifndef FL_GEOM_AFFINE_H
#define FL_GEOM_AFFINE_H
#include "geom/mat3.h"
#include "geom/surface.h"

/* x becomes t + s Q x, Q orthogonal.  Lengths scale by s, volumes by s^3, moments of inertia at density one
 * by s^5, for any Q and t. */
typedef struct {
    fl_mat3 q;
    double s;  /* > 0 */
    fl_vec3 t; /* [m] */
} fl_affine;

/* The identity. */
fl_affine fl_affine_identity(void);

/* Rotation by an angle in degrees, counter-clockwise seen against the axis, which is not zero and need not be
 * a unit vector:
 *     R = c 1 + (1 - c) a a^T + s [a]x,  a = axis / |axis|,  c, s = cosine, sine
 * Multiples of 90 degrees about a coordinate axis have elements 0, 1 and -1 exactly; else R is orthogonal to
 * a few 1e-16.  Source: Rodrigues 1840. */
fl_mat3 fl_affine_rotation(fl_vec3 axis, double degrees);

/* a b */
fl_mat3 fl_affine_matrix_product(const fl_mat3 *a, const fl_mat3 *b);

/* Maps a part.  If Q is a reflection (determinant -1), the winding of triangles is reversed, so that outward
 * normals stay outward. */
void fl_part_map(fl_part *p, const fl_affine *m);

#endif
