/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_certificate.h -- counts and sums that a cut must satisfy, found without cutting.
 *
 * Planes in general position divide a convex body into
 *     1 + planes + lines + points
 * parts: planes that pass through it, pairs whose line does, triples whose point lies inside.  Volumes add up
 * to the body, and the joint area of a set is that of the sections of its planes.  Each is summed over the
 * convex pieces that joints cut.  Source: Zaslavsky, Mem. AMS 154 (1975), for the count. */
#ifndef FL_BLOCK_BLOCK_CERTIFICATE_H
#define FL_BLOCK_BLOCK_CERTIFICATE_H
#include "block/face_pairs.h"

typedef struct {
    int64_t planes, lines, points, pieces; /* the count: their sum */
    int special; /* 1: planes not in general position, the count is an upper bound */
    int full;    /* 1: all sets have persistence 1 by skip, so that it must be met */
    int32_t blocks;
    double volume, least, most, square_sum; /* sum, smallest, largest, sum of squares [m3], [m6] */
    int32_t least_faces, most_faces;
    double *section,
        *area;       /* [sets] area of the sections of its planes; of its joints and intact pairs [m2] */
    double *intact;  /* [sets] part of area that is intact [m2] */
    double surfaces; /* area of intact pairs on planes of surfaces [m2] */
} fl_block_certificate;

/* Fills c for the blocks of m before slivers are removed. */
int fl_block_certify(fl_block_certificate *c, const fl_block_model *m, const fl_face_pairs *pairs,
                     const fl_joint_sets *sets, fl_err *err);
void fl_block_certificate_free(fl_block_certificate *c);

#endif
