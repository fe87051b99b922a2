/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_simplify.h -- simplifies a surface within a distance. */
#ifndef FL_SHIM_CGAL_SIMPLIFY_H
#define FL_SHIM_CGAL_SIMPLIFY_H
#include "shim/cgal_repair.h"

/* Collapses edges while the resulting triangles stay within `distance` of the original s, in the order of
 * least swept volume.  Boundaries, and edges where more than two triangles meet, are kept.  The opposite
 * distance, from s to the result, is not bounded: measure it with fl_cgal_distance().
 *   s          x and t from malloc() or fl_alloc(); replaced
 *   distance   > 0                                           [m]
 *   removed  out: number of removed triangles
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM, and s unchanged.
 * Source: Lindstrom & Turk, IEEE Visualization 1998, cost; Wang et al., ACM ToG 39 (2020) 41, envelope; both
 * as of CGAL 5.5. */
int fl_cgal_simplify(fl_soup *s, double distance, int32_t *removed, fl_err *err);

#endif
