/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_voronoi.h -- neighbours in a Voronoi diagram and orientation of three points, decided exactly by
 * CGAL's filtered predicates. */
#ifndef FL_SHIM_CGAL_VORONOI_H
#define FL_SHIM_CGAL_VORONOI_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The neighbours of each site in the Delaunay triangulation: the cell of site i is the intersection of all
 * half-planes nearer to i than to a neighbour.  No circumcentre is computed, so nothing is rounded here: a
 * cell follows by cutting with bisectors, with the rounding of one cut.
 *   site[n]      finite
 *   name[n]      distinct names of the sites; the sites may be given in another, faster order than their
 *                names
 *   first[n + 1] out: the neighbours of site i are (*near)[first[i] .. first[i + 1]), sorted by name
 *   near         out: freed with free()
 * Returns 0, or -1 with FL_INPUT (two sites coincide, with their names) or FL_SYSTEM.  O(n log n).
 * Source: CGAL, 2D Triangulations, Delaunay_triangulation_2 on the
 * Exact_predicates_inexact_constructions_kernel. */
int fl_cgal_neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first, int32_t **near,
                       fl_err *err);

/* 1 if a, b, c turn left, -1 if they turn right, 0 if they lie on one line; exact.  Also 0 if memory for the
 * exact arithmetic runs out. */
int fl_cgal_orientation(fl_vec2 a, fl_vec2 b, fl_vec2 c);

#ifdef __cplusplus
}
#endif
#endif
