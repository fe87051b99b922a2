/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pairs.h -- candidate pairs: all (i, j) whose boxes meet, sorted by i, then j. */
#ifndef FL_BROAD_PAIRS_H
#define FL_BROAD_PAIRS_H
#include "broad/bvh.h"

typedef struct {
    int64_t *first;   /* [n + 1] offsets into partner                                      */
    int32_t *partner; /* [first[n]] j of the pairs of i, ascending; i < j                */
    fl_bvh tree;
    int32_t first_cap, partner_cap;
} fl_pairs;

/* Find the pairs (i, j), i < n, i < j < total.
 *   box[total]  those below n are bodies that move and may pair with everything; pairs among [n, total)
 *               are not sought.  The last `wide` boxes may be unbounded (walls); they are tried one by one.
 * The lists are the same for any number of threads.  0, or -1 with FL_SYSTEM. */
int fl_pairs_find(fl_pairs *p, const fl_aabb *box, int32_t n, int32_t total, int32_t wide, fl_err *err);

void fl_pairs_free(fl_pairs *p);

#endif
