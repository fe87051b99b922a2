/* SPDX-License-Identifier: GPL-3.0-or-later */
/* closest_simplex.h -- closest points of two points, segments or triangles, by closed formulae over all pairs
 * of their sub-simplices. */
#ifndef FL_NARROW_CLOSEST_SIMPLEX_H
#define FL_NARROW_CLOSEST_SIMPLEX_H
#include "narrow/simplex.h"

/* A point, segment or triangle of a core. */
typedef struct {
    int32_t n;    /* 1 to 3 vertices */
    int32_t i[3]; /* their numbers in the core, ascending */
    fl_vec3 v[3]; /* world [m] */
} fl_subsimplex;

/* Closest points of hull(a) and hull(b), which do not overlap.  Candidates: vertex and triangle, edge and
 * edge, vertex and edge, vertex and vertex, each where the feet of the common normal lie inside.  Normals:
 *     n = e x g / |e x g|                       triangle, crossing edges
 *     n = (u - (u.e / e.e) e) / |...|           vertex and edge
 * fine = 0: doubles; double-doubles only where e and g are nearly parallel, or the vertex is a hundred times
 *     nearer than the end of the edge.  The candidate with the least slack wins: the sum of max n.(p - v)
 *     on a and max n.(v - q) on b, what the planes across n leave beyond them.  It is zero for the right
 *     candidate and linear in the error of n, whereas the distance is quadratic.
 * fine = 1: double-doubles throughout; the candidate with the least distance wins, which at 106 bits
 *     distinguishes normals that differ by 1e-16.
 *     size   length of the pair to which rounding is relative [m]
 * Sets d, n, pa, pb and the features of *out and returns 1; 0, and leaves *out, when no candidate has a
 * normal. */
int fl_closest_simplex_points(const fl_subsimplex *a, const fl_subsimplex *b, double size, int fine,
                              fl_gap *out);

#endif
