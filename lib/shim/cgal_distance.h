/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_distance.h -- guaranteed bounds of the one-sided Hausdorff distance of triangulated surfaces. */
#ifndef FL_SHIM_CGAL_DISTANCE_H
#define FL_SHIM_CGAL_DISTANCE_H
#include "shim/cgal_repair.h"

/* The largest distance of any point of a from b,
 *     h(a, b) = max_{x in a} min_{y in b} |x - y|,
 * within the bounds *least <= h <= *most.  The distance from one triangle of b is convex, so over a piece of
 * a it is largest at a corner.  Pieces are cut along the prism over their nearest triangle; the part inside
 * the prism is bounded, the rest is split further.  Flat faces with a different triangulation give 0 within
 * rounding.  Ends if *most - *least <= tol + least / 100, or if there are a hundred times as many pieces as
 * triangles in both; the pieces left then count with their size, so that *most still holds.
 *   a, b   not empty                         [m]
 *   tol    >= 0                              [m]
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM.  Compare Tang, Lee & Kim, ACM ToG 28 (2009) 74. */
int fl_cgal_distance(const fl_soup *a, const fl_soup *b, double tol, double *least, double *most,
                     fl_err *err);

#endif
