/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sliver.h -- blocks too thin or too small to stand alone: merged with a neighbour, or left out.
 *
 * A sliver is narrower or smaller than the rule says, or so sharp that nothing is left of it when its faces
 * move in by the dilation radius.  A sliver is merged across its largest face on which it lies fully on a
 * neighbour, if their union is convex; if not, across the next.  Faces of the two in one plane become one;
 * corners on its sides stay. */
#ifndef FL_BLOCK_SLIVER_H
#define FL_BLOCK_SLIVER_H
#include "block/face_pairs.h"

typedef struct {
    double min_width;  /* [m] */
    double min_volume; /* [m3] */
    double radius;     /* dilation radius [m] */
    int keep;          /* 1: count them only */
} fl_sliver_rule;

/* What became of a sliver. */
typedef struct {
    fl_vec3 x;            /* centroid */
    double volume, width; /* [m3], [m] */
    int merged;
} fl_sliver;

typedef struct {
    int32_t n, cap, merged;
    double lost; /* volume left out [m3] */
    fl_sliver *sliver;
} fl_slivers;

/* Removes slivers from m; pairs are found anew. */
int fl_slivers_remove(fl_slivers *s, fl_block_model *m, fl_face_pairs *pairs, const fl_joint_sets *sets,
                      uint64_t seed, const fl_sliver_rule *rule, fl_err *err);
void fl_slivers_free(fl_slivers *s);

#endif
