/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_crossing.h -- the term of crossing edges of the law `quick` (quick_law.h). */
#ifndef FL_PATCH_QUICK_CROSSING_H
#define FL_PATCH_QUICK_CROSSING_H
#include "patch/quick_rows.h"

/* Adds the crossings, in the frame of B.
 *   d        of A over B;  rho_b: radius of the features of B [m]
 *   axis     direction from B to A of overlapping cores, or 0;  overlap: raised to the largest */
void fl_quick_add_crossings(const fl_quick_direction *d, double rho_b, fl_vec3 axis, fl_quick_total *to,
                            double *overlap);

#endif
