/* SPDX-License-Identifier: GPL-3.0-or-later */
/* list_range.h -- the poses in which a list of features of two cores holds: of feature_pairs.h and
 * quick_list.h. */
#ifndef FL_PATCH_LIST_RANGE_H
#define FL_PATCH_LIST_RANGE_H
#include "geom/mat3.h"

/* True if |o - o0|^2 < max_shift2 [m2] and |M - M0|^2 < max_turn2 for the pose M, o of A. */
static inline int fl_pose_in_range(const fl_mat3 *M, fl_vec3 o, const fl_mat3 *M0, fl_vec3 o0,
                                   double max_shift2, double max_turn2)
{
    double turn2 = 0.0;
    if (!(v3_norm2(v3_sub(o, o0)) < max_shift2)) return 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) turn2 += (M->m[i][k] - M0->m[i][k]) * (M->m[i][k] - M0->m[i][k]);
    return turn2 < max_turn2;
}

#endif
