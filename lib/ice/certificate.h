/* SPDX-License-Identifier: GPL-3.0-or-later */
/* certificate.h -- measurement of a plane field of floes, from the written corners alone. */
#ifndef FL_ICE_CERTIFICATE_H
#define FL_ICE_CERTIFICATE_H
#include <stdint.h>
#include "base/err.h"
#include "ice/floes.h"

typedef struct {
    double total_area;                    /* sum of the areas of all outer polygons [m2] */
    double mean_area, min_area, max_area; /* area of an outer polygon [m2] */
    double cv;                            /* standard deviation (of n, not n - 1) over the mean */
    int32_t min_area_floe, max_area_floe;
    double mean_sides;          /* mean number of sides */
    double min_side, min_angle; /* shortest side of a core [m], sharpest corner [rad] */
    int32_t min_side_floe, min_angle_floe;
    double min_gap;          /* least distance between two outer polygons, infinite for one floe [m] */
    int32_t min_gap_pair[2]; /* -1 for one floe */
    int64_t overlaps;        /* pairs of outer polygons that touch or overlap */
    int32_t nonconvex;       /* floes whose core or outer polygon is not convex */
} fl_certificate;

/* Measure floes; a->n >= 1.
 *
 * A polygon is convex, simple and counter-clockwise if every corner that is not on a side lies strictly to
 * the left of that side.  Exact predicates decide this on the corners as they are.  The faces of the prism
 * on such a polygon point outward, and no two corners coincide.
 *
 * A pair is separate if all corners of one polygon lie strictly beyond a side of the other, decided
 * likewise; for convex polygons this is necessary as well.  Pairs whose boxes do not meet are separate, so
 * all pairs are covered.
 *
 * Cost n log n.  Returns 0, or -1 with FL_SYSTEM. */
int fl_certificate_make(fl_certificate *out, const fl_floes *a, fl_err *err);

#endif
