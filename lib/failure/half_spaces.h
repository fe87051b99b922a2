/* SPDX-License-Identifier: GPL-3.0-or-later */
/* half_spaces.h -- the outer sharp shape of a body as an intersection of half-spaces. */
#ifndef FL_FAILURE_HALF_SPACES_H
#define FL_FAILURE_HALF_SPACES_H
#include "geom/aabb.h"
#include "geom/mat3.h"
#include "geom/poly.h"

/* A convex body as the half-spaces n.x <= c. */
enum { FL_HALF_SPACES = 64 };
typedef struct {
    int n;
    fl_vec3 normal[FL_HALF_SPACES];
    double c[FL_HALF_SPACES];
    fl_aabb box; /* encloses the body */
} fl_half_spaces;

/* Half-spaces of core p moved outward by r, in a frame where it stands at o with axes M.  Of more than
 * FL_HALF_SPACES faces the first ones count, which encloses the body.  */
void fl_half_spaces_of(fl_half_spaces *q, const fl_poly *p, double r, const fl_mat3 *M, fl_vec3 o);

#endif
