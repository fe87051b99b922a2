/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_points.h -- the vertex and edge terms of the law `quick` (quick_law.h). */
#ifndef FL_PATCH_QUICK_POINTS_H
#define FL_PATCH_QUICK_POINTS_H
#include "patch/quick_rows.h"

/* Adds vertices and edges of the own core of one direction.  -1 when memory runs out.
 *   support    [n] pairs of faces that bear edges;  overlap: raised to the largest */
int fl_quick_add_points(fl_quick_scratch *w, const fl_quick_direction *d, const fl_quick_support *support,
                        int32_t n, fl_quick_total *to, double *overlap);

#endif
