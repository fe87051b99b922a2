/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_simplify.h -- the same surface from fewer triangles, within a distance. */
#ifndef FL_SHIM_CGAL_SIMPLIFY_H
#define FL_SHIM_CGAL_SIMPLIFY_H
#include "shim/cgal_repair.h"

/* Collapse edges as long as the triangles that come of it stay within `distance` of s as it came in, the
 * cheapest first by the volume they sweep.  Rims, and edges where more than two triangles meet, stay as they
 * are.  That every point of s keeps the distance from the result is not part of it: measure with
 * fl_cgal_distance().
 *   s          x and t from malloc() or fl_alloc(); replaced
 *   distance   > 0                                           [m]
 *   gone       out: triangles less than before
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err, and s as it was.
 * Source: Lindstrom & Turk, IEEE Visualization 1998, cost; Wang et al., ACM ToG 39 (2020) 41, envelope; both
 * as of CGAL 5.5. */
int fl_cgal_simplify(fl_soup *s, double distance, int32_t *gone, fl_err *err);

#endif
