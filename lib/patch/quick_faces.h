/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quick_faces.h -- the face term of the law `quick` (quick_law.h). */
#ifndef FL_PATCH_QUICK_FACES_H
#define FL_PATCH_QUICK_FACES_H
#include "patch/quick_rows.h"

/* Adds the pairs of faces of one direction.  -1 when memory runs out.
 *   support    out: [*n] pairs that bear edges, in the scratch
 *   overlap  raised to the largest */
int fl_quick_add_faces(fl_quick_scratch *w, const fl_quick_direction *d, fl_quick_total *to,
                       const fl_quick_support **support, int32_t *n, double *overlap);

#endif
