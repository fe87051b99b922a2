/* SPDX-License-Identifier: GPL-3.0-or-later */
/* faces.h -- common sides of floes in a field without gaps, found on the written outer polygons. */
#ifndef FL_ICE_FACES_H
#define FL_ICE_FACES_H
#include <stdint.h>
#include "base/err.h"
#include "ice/floes.h"

/* Lines coincide if their distance is below this fraction of the size of the field (plus some ulps of its
 * distance from the origin).  Shorter common sides, and overlaps that are not deeper, count as rounding. */
#define FL_FACES_TOL 1e-10

typedef struct {
    int32_t i, j; /* floes, i < j                                  */
    fl_vec2 a, b; /* ends, counter-clockwise about floe i [m] */
} fl_face;

typedef struct {
    int32_t n;
    fl_face *face;       /* [n] ascending in (i, j), a pair at most once */
    double total_length; /* sum of the lengths of all faces [m] */
    double perimeter;    /* sum of the perimeters of all floes [m] */
    double max_overlap;  /* largest overlap of two floes, 0 if none [m] */
    int32_t max_overlap_pair[2];
    double tolerance; /* below which lines coincide [m] */
} fl_faces;

/* Find the faces.  For floes that fill their field, perimeter - 2 total_length is the length of its
 * outline.  The overlap of two floes is the least distance by which one has to move along a normal of a
 * side to separate them.  Cost n log n.  Returns 0, or -1 with FL_SYSTEM; out is unchanged then. */
int fl_faces_find(fl_faces *out, const fl_floes *a, fl_err *err);

void fl_faces_free(fl_faces *a); /* accepts a zeroed struct, leaves a zeroed one */

#endif
