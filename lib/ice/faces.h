/* SPDX-License-Identifier: GPL-3.0-or-later */
/* faces.h -- where floes of a field without gaps touch: the sides, or pieces of sides, that two of them
 * share.  Found on the outer polygons that are written and not on the cells they came from. */
#ifndef FL_ICE_FACES_H
#define FL_ICE_FACES_H
#include <stdint.h>
#include "base/err.h"
#include "ice/floes.h"

/* Lines nearer to each other than this part of the field's size (and some ulps of its distance from the
 * origin) are one; shared pieces that are shorter, and overlaps that are not deeper, are rounding. */
#define FL_FACES_TOL 1e-10

typedef struct {
    int32_t i, j; /* floes, i < j                                  */
    fl_vec2 a, b; /* ends, counter-clockwise round floe i      [m] */
} fl_face;

typedef struct {
    int32_t n;
    fl_face *face;       /* [n] ascending in (i, j), a pair at most once    */
    double total_length; /* sum of the lengths of all faces             [m] */
    double perimeter;    /* sum of the outlines of all floes            [m] */
    double max_overlap;  /* deepest overlap of two floes, 0 when none   [m] */
    int32_t max_overlap_pair[2];
    double tolerance; /* what counted as together                 [m] */
} fl_faces;

/* Find them.  For floes that fill their field,  outline - 2 length  is the outline of the field.
 * The depth of an overlap is the least way by which one of the two can be moved along a normal of a side to
 * free it.  n log n.  Returns 0, or -1 with FL_SYSTEM; out is untouched then. */
int fl_faces_find(fl_faces *out, const fl_floes *a, fl_err *err);

void fl_faces_free(fl_faces *a); /* accepts a zeroed struct, leaves one */

#endif
