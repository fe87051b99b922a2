/* SPDX-License-Identifier: GPL-3.0-or-later */
/* face_pairs.h -- which faces of two blocks lie on each other.
 *
 * Only faces made by the same plane, from its two sides, can: they are compared in that plane, with a sweep
 * along one direction over their bounding rectangles.  Where all blocks were cut by a plane the two are
 * equal; with persistence they overlap in part. */
#ifndef FL_BLOCK_FACE_PAIRS_H
#define FL_BLOCK_FACE_PAIRS_H
#include "block/block_model.h"

typedef struct {
    int32_t i, j, fi, fj; /* blocks, i < j, and their faces */
    int32_t plane;        /* that made them */
    int intact;           /* 1: no joint, by persistence, or a plane of a surface */
    double area;          /* of the common part [m2] */
    fl_vec3 x;            /* its centroid [m] */
} fl_face_pair;

typedef struct {
    int32_t n, cap;
    fl_face_pair *pair; /* [n] sorted by (i, j) */
} fl_face_pairs;

/* Finds all pairs with a common part of more than 1e-9 of the smaller face. */
int fl_face_pairs_find(fl_face_pairs *s, const fl_block_model *m, const fl_joint_sets *sets, uint64_t seed,
                       fl_err *err);
void fl_face_pairs_free(fl_face_pairs *s);

#endif
