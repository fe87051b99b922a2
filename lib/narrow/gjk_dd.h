/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk_dd.h -- second stage of the distance of two convex cores (gjk.h): GJK iterations in double-double
 * arithmetic, for cores that nearly or actually overlap. */
#ifndef FL_NARROW_GJK_DD_H
#define FL_NARROW_GJK_DD_H
#include "narrow/gjk_double.h"

/* Iterates from simplex s to the closest points with 106 bits.  All 15 sub-simplices are tried in each step,
 * so the sign of a rounded number cannot lose the closest one, and the distance falls strictly, so no simplex
 * repeats.  Sets d, n, pa, pb and overlap of *out and adds to its iterations; s ends as the vertex
 * differences that carry the result. A distance below 2^-50 of size is a touch: overlap = 1, d = 0, n = 0.
 * Returns out->overlap. */
int fl_gjk_dd(fl_core a, fl_core b, double size, fl_simplex *s, fl_gap *out);

#endif
