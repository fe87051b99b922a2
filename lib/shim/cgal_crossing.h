/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_crossing.h -- pairs of triangles that meet where they are not joined. */
#ifndef FL_SHIM_CGAL_CROSSING_H
#define FL_SHIM_CGAL_CROSSING_H
#include "shim/cgal_repair.h"

typedef struct {
    int32_t crossings; /* pass through each other, or cover each other over some area       */
    int32_t touching;  /* meet in a point or along a line only, without a common corner there */
} fl_crossing;

/* Count the pairs of triangles of s that meet elsewhere than in corners and edges they have in common, which
 * are told by their places.  Two triangles in different planes cross when each has corners strictly on both
 * sides of the other's plane and what they have in common is longer than a point.  Decided in exact
 * arithmetic, with a filter before it; triangles of collinear corners are passed over.  The time grows as
 * n log n with the number of triangles and with that of the pairs whose boxes meet.
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err.
 * Source: Zomorodian & Edelsbrunner, Int. J. Comput. Geom. Appl. 12 (2002) 143, boxes; CGAL 5.5. */
int fl_cgal_crossings(const fl_soup *s, fl_crossing *c, fl_err *err);

/* The same for one pair, by its corners a[9] and b[9], x y z each.  FL_APART, FL_TOUCHES, FL_CROSSES, or -1
 * with FL_NUMERIC or FL_SYSTEM.  May be called by several threads at once. */
enum { FL_APART, FL_TOUCHES, FL_CROSSES };
int fl_cgal_classify_triangles(const double *a, const double *b, fl_err *err);

#endif
