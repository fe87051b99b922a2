/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pairs.h -- candidate pairs: all (i, j) with overlapping boxes, sorted by i, then j, then image. */
#ifndef FL_BROAD_PAIRS_H
#define FL_BROAD_PAIRS_H
#include "broad/bvh.h"

typedef struct {
    fl_vec3 period;   /* period in each direction, 0 where space is not periodic           [m] */
    int64_t *first;   /* [n + 1] offsets into partner */
    int32_t *partner; /* [first[n]] j of the pairs of i, ascending; i < j */
    int32_t *image;   /* [first[n]] image of j that overlaps i, ascending; NULL without a period */
    fl_bvh tree;
    const uint8_t *absent; /* [n] borrowed, or NULL */
    int32_t first_cap, partner_cap, image_cap;
} fl_pairs;

/* Finds the pairs (i, j), i < n, i < j < total.
 *   box[total]  boxes below n are moving bodies and may pair with everything; pairs within [n, total) are not
 *               searched.  The last `wide` boxes may be unbounded (walls); they are tested one by one.
 * With a period, i is tested against all images of j, shifted by whole periods, up to 15 to each side; bodies
 * should be wrapped into the cell before.  A body does not pair with itself, and a wide box has no images.
 * Bodies k < n where p->absent[k] is not 0 are left out; absent NULL: none.
 * The lists are the same for any number of threads.  0, or -1 with FL_SYSTEM. */
int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err);

/* Shift of an image of fl_pairs along axis 0, 1, 2, in periods. */
int fl_pairs_image_shift(int32_t image, int axis);

/* Frees the lists and the tree; period and absent are kept. */
void fl_pairs_clear(fl_pairs *p);

void fl_pairs_free(fl_pairs *p);

#endif
