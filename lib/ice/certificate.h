/* SPDX-License-Identifier: GPL-3.0-or-later */
/* certificate.h -- what a plane field of floes is, measured on the corners that are written and not on the
 * way by which they were made. */
#ifndef FL_ICE_CERTIFICATE_H
#define FL_ICE_CERTIFICATE_H
#include <stdint.h>
#include "base/err.h"
#include "ice/floes.h"

typedef struct {
    double total_area;                    /* area of all outer polygons                             [m2] */
    double mean_area, min_area, max_area; /* area of one                                            [m2] */
    double cv;                            /* standard deviation (of n, not n - 1) over the mean          */
    int32_t min_area_floe, max_area_floe;
    double mean_sides;          /* mean number                                                 */
    double min_side, min_angle; /* shortest side of a core [m], sharpest corner          [rad] */
    int32_t min_side_floe, min_angle_floe;
    double min_gap;          /* least distance between two outer polygons, infinite when there is one [m] */
    int32_t min_gap_pair[2]; /* -1 when there is one                                        */
    int64_t overlaps;        /* pairs of outer polygons that touch or overlap               */
    int32_t nonconvex;       /* floes whose core or outer polygon is not convex             */
} fl_certificate;

/* Measure floes of at least one.
 *
 * A polygon is convex and runs once round, counter-clockwise, when every corner that is not on a side lies
 * strictly to the left of it, which is decided by exact predicates on the corners as they are: then the faces
 * of the prism on it face outward, and no two corners coincide.
 * A pair counts as apart when all corners of one lie strictly beyond a side of the other, decided likewise;
 * for convex polygons no other pair is apart.  All pairs are covered: those whose boxes do not meet are apart
 * already.
 * Returns 0, or -1 with FL_SYSTEM.  n log n. */
int fl_certificate_make(fl_certificate *out, const fl_floes *a, fl_err *err);

#endif
