/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_distance.h -- how far one triangulated surface strays from another, as a bound that holds. */
#ifndef FL_SHIM_CGAL_DISTANCE_H
#define FL_SHIM_CGAL_DISTANCE_H
#include "shim/cgal_repair.h"

/* The largest distance of any point of a from b (the one-sided Hausdorff distance)
 *     h(a, b) = max_{x in a} min_{y in b} |x - y|
 * between two numbers: *least <= h <= *most.  The distance from one triangle of b is convex, so over a piece
 * of a it is largest at a corner.  Pieces are cut along the prism over their nearest triangle, and what the
 * prism holds is bounded; the rest goes on.  So flat faces that were only cut otherwise give 0 to rounding.
 * Ends where *most - *least <= tol + least / 100, or when pieces become as many as a hundred times the
 * triangles of both; what is open then counts with its size, so that *most still holds.
 *   a, b   not empty                         [m]
 *   tol    >= 0                              [m]
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err.  Compare Tang, Lee & Kim, ACM ToG 28 (2009) 74. */
int fl_cgal_distance(const fl_soup *a, const fl_soup *b, double tol, double *least, double *most,
                     fl_err *err);

#endif
