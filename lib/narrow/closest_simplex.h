/* SPDX-License-Identifier: GPL-3.0-or-later */
/* closest_simplex.h -- nearest points of two points, segments or triangles, by closed formulae over all their
 * parts. */
#ifndef FL_NARROW_CLOSEST_SIMPLEX_H
#define FL_NARROW_CLOSEST_SIMPLEX_H
#include "narrow/simplex.h"

typedef struct {
    int32_t n;    /* 1 to 3 vertices */
    int32_t i[3]; /* their numbers in the core, ascending */
    fl_vec3 v[3]; /* world [m] */
} fl_subsimplex;

/* Nearest points of hull(a) and hull(b), which do not meet: vertex against triangle, edge against edge,
 * vertex against edge, vertex against vertex, each where the feet of the common normal lie inside; of all
 * the normals
 *     n = e x g / |e x g|  (faces, crossing edges),   n = (u - (u.e / e.e) e) / |...|  (vertex and edge).
 * fine = 0: doubles; pairs of doubles only where e and g are nearly parallel, or the vertex is a hundred
 *   times nearer than the end of the edge.  The parts compete by what the planes across n leave beyond
 *   them, sum of max n.(p - v) on a and max n.(v - q) on b: zero for the right one, and linear in the
 *   error of n, where the distance is only quadratic.
 * fine = 1: pairs of doubles throughout; the parts compete by distance, which at 106 bits tells normals
 * apart by 1e-16.
 *   size   of the pair: a length to which rounding is relative                                   [m]
 * Sets d, n, pa, pb and the features of *out, and returns 1; 0, and leaves *out, when no part has a
 * normal. */
int fl_closest_simplex_points(const fl_subsimplex *a, const fl_subsimplex *b, double size, int fine, fl_gap *out);

#endif
