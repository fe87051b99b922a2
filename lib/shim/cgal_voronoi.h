/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_voronoi.h -- which Voronoi cells touch, and on which side of a line a point lies: both decided
 * exactly, by CGAL's filtered predicates. */
#ifndef FL_SHIM_CGAL_VORONOI_H
#define FL_SHIM_CGAL_VORONOI_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The neighbours of each site in the Delaunay triangulation: the cell of site i in the plane is where all the
 * half-planes nearer to i than to a neighbour overlap.  No circumcentre is computed, so that nothing is
 * rounded: a cell follows by cutting with bisectors, and its rounding is that of one cut.
 *   site[n]      finite
 *   name[n]      how the sites are called: all different; it may be an order that is good to work in, given
 *                to sites that have another order for whoever asks
 *   first[n + 1] out: the neighbours of site i are (*near)[first[i] .. first[i + 1]), by rising name
 *   near         out: freed with free()
 * Returns 0, or -1 with FL_INPUT (two sites coincide, the names of which) or FL_SYSTEM.  n log n.
 * Source: CGAL, 2D Triangulations, Delaunay_triangulation_2 on the
 * Exact_predicates_inexact_constructions_kernel. */
int fl_cgal_neighbours(int32_t n, const fl_vec2 *site, const int32_t *name, int32_t *first, int32_t **near,
                       fl_err *err);

/* 1 when a, b, c turn left, -1 when they turn right, 0 when they lie on one line; exact.  Also 0 when there
 * is no memory for the exact arithmetic that a close decision takes. */
int fl_cgal_orientation(fl_vec2 a, fl_vec2 b, fl_vec2 c);

#ifdef __cplusplus
}
#endif
#endif
