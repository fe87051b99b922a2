/* SPDX-License-Identifier: GPL-3.0-or-later */
/* affine.h -- maps that keep shapes: turn, mirror, scale, move. */
#ifndef FL_GEOM_AFFINE_H
#define FL_GEOM_AFFINE_H
#include "geom/mat3.h"
#include "geom/surface.h"

/* x becomes t + s Q x, Q orthogonal: lengths times s, volumes times s^3, moments of inertia of a body of
 * density one times s^5, whatever Q and t are. */
typedef struct {
    fl_mat3 q;
    double s;  /* > 0 */
    fl_vec3 t; /* [m] */
} fl_affine;

/* The map that changes nothing. */
fl_affine fl_affine_identity(void);

/* The rotation by so many degrees, counter-clockwise seen against the axis, which need not be of length one
 * and is not zero:
 *     R = c 1 + (1 - c) a a^T + s [a]x,  a = axis / |axis|,  c, s = cosine, sine
 * Multiples of 90 degrees about a coordinate axis have elements 0, 1 and -1 exactly; else R is orthogonal to
 * a few 1e-16. Source: Rodrigues 1840. */
fl_mat3 fl_affine_rotation(fl_vec3 axis, double degrees);

/* a b */
fl_mat3 fl_affine_matrix_product(const fl_mat3 *a, const fl_mat3 *b);

/* Map all of a part.  Where Q mirrors (its determinant is -1), triangles are wound the other way, so that
 * normals that looked outward still do. */
void fl_part_map(fl_part *p, const fl_affine *m);

#endif
