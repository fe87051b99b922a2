/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moments.h -- volume, area, centroid and inertia of solids of triangles and cones, summed in 106 bits. */
#ifndef FL_GEOM_MOMENTS_H
#define FL_GEOM_MOMENTS_H
#include "geom/mat3.h"
#include "geom/surface.h"

/* Of triangles a, b, c (about the centre o of the box), each closing a tetrahedron with o, and of cones:
 *     D   = a.((b - a) x (c - a)),   V = sum D / 6,   A = sum |(b - a) x (c - a)| / 2
 *     V C = sum D (a + b + c) / 24
 *     int x x^T dV = sum D / 120 (a a^T + b b^T + c c^T + (a + b + c)(a + b + c)^T)
 * and the tensor of inertia about the centroid, density one, J = tr(S) 1 - S, S = int (x - C)(x - C)^T dV.
 * Parts and cones are added as if they did not overlap.  Each term is a double with a relative error of a few
 * 1e-16, since the sides of small triangles are exact differences.  The sums have 106 bits, so millions of
 * terms lose no more than one does.  If the triangles are not closed, V, C and J are mere sums. */
typedef struct {
    double volume;    /* [m^3] */
    double area;      /* [m^2] */
    fl_vec3 centroid; /* [m]; that of the box if V is 0 */
    fl_mat3 inertia;  /* [m^5] */
} fl_moments;

/* Of all n parts.  Cannot fail; empty parts give zeros.  Source: Tonon, J. Math. Stat. 1 (2005) 8, for the
 * tetrahedron; truncated cones are integrated here in closed form. */
fl_moments fl_moments_of(const fl_part *p, int32_t n);

#endif
