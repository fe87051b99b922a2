/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pairs.h -- candidate pairs: all (i, j) whose boxes meet, sorted by i, then j, then image. */
#ifndef FL_BROAD_PAIRS_H
#define FL_BROAD_PAIRS_H
#include "broad/bvh.h"

typedef struct {
    fl_vec3 period;   /* in a direction where it is > 0 space repeats itself            [m] */
    int64_t *first;   /* [n + 1] offsets into partner                                      */
    int32_t *partner; /* [first[n]] j of the pairs of i, ascending; i < j                */
    int32_t *image;   /* [first[n]] which image of j meets i, rising; NULL without a period */
    fl_bvh tree;
    const uint8_t *absent; /* [n] borrowed, or NULL */
    int32_t first_cap, partner_cap, image_cap;
} fl_pairs;

/* Find the pairs (i, j), i < n, i < j < total.
 *   box[total]  those below n are bodies that move and may pair with everything; pairs among [n, total)
 *               are not sought.  The last `wide` boxes may be unbounded (walls); they are tried one by one.
 * With a period i meets every image of j, box[j] moved by whole periods, up to 15 of them to each side, so
 * the boxes had better be brought together before; a body does not meet itself, and a wide box has no
 * images.
 * Bodies k < n where p->absent[k] is not 0 are left out; absent NULL: none.
 * The lists are the same for any number of threads.  0, or -1 with FL_SYSTEM. */
int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err);

/* By how many periods along axis 0, 1, 2 an image of fl_pairs has been moved. */
int fl_pairs_image_shift(int32_t image, int axis);

/* Let go of what was found and of what it was found with; period and absent stay. */
void fl_pairs_clear(fl_pairs *p);

void fl_pairs_free(fl_pairs *p);

#endif
