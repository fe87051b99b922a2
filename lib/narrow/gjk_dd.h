/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk_dd.h -- the second stage: the same walk in pairs of doubles, for cores that nearly meet or do. */
#ifndef FL_NARROW_GJK_DD_H
#define FL_NARROW_GJK_DD_H
#include "narrow/gjk_double.h"

/* From simplex s to the nearest points, with 106 bits; all 15 parts of the simplex are tried at each
 * step, so that no sign can lose the nearest one, and the distance falls strictly, so that no simplex
 * comes back. Sets d, n, pa, pb and overlap of *out, adds to its iterations; s ends as the points that
 * carry the answer. A distance below 2^-50 of size is a touch: overlap, d = 0, n = 0.  Returns
 * out->overlap. */
int fl_gjk_dd(fl_core a, fl_core b, double size, fl_simplex *s, fl_gap *out);

#endif
