/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_crossing.h -- finds intersecting triangles of a surface, in exact arithmetic. */
#ifndef FL_SHIM_CGAL_CROSSING_H
#define FL_SHIM_CGAL_CROSSING_H
#include "shim/cgal_repair.h"

typedef struct {
    int32_t crossings; /* they intersect, or overlap in a common plane */
    int32_t touching;  /* they meet in a point or along a line only, without a common corner there */
} fl_crossing;

/* Counts the pairs of triangles of s that meet outside their common corners and edges, which are identified
 * by coordinates.  Two triangles in different planes cross if each has corners strictly on both sides of the
 * other's plane and their intersection is longer than a point.  Exact arithmetic, with a floating-point
 * filter; triangles of collinear corners are ignored.  The time is O(n log n) in the number of triangles,
 * plus the number of pairs whose boxes overlap.
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM.
 * Source: Zomorodian & Edelsbrunner, Int. J. Comput. Geom. Appl. 12 (2002) 143, boxes; CGAL 5.5. */
int fl_cgal_crossings(const fl_soup *s, fl_crossing *c, fl_err *err);

/* Same for one pair, by the corners a[9] and b[9], x y z each.  Returns FL_APART, FL_TOUCHES, FL_CROSSES, or
 * -1 with FL_NUMERIC or FL_SYSTEM.  Safe to call from several threads. */
enum { FL_APART, FL_TOUCHES, FL_CROSSES };
int fl_cgal_classify_triangles(const double *a, const double *b, fl_err *err);

#endif
