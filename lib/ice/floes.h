/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floes.h -- floes of a given concentration inside cells that fill a region.
 *
 * The sides of every cell move inward by a common distance, the inset d; the result is the floe as the
 * water sees it (outer polygon).  Moved inward by the dilation radius once more it is the core, which is
 * written.  Dilating the sides of the core gives the outer polygon back (requested sizes are outer sizes,
 * voronoi-ice(1)), so both must have the same sides:
 *  - A side is dropped if it vanishes between outer polygon and core, or is shorter than FL_FLOES_SHORT_SIDE
 *    times the inscribed radius of the core, and if the sharper corner that remains is inside the cell by
 *    half the inset.
 *  - Otherwise the side is kept and moves inward until the side of the core is FL_FLOES_MIN_SIDE times
 *    that radius long (less at a blunt corner, so that the inscribed circle is never cut).
 *  - A corner of the core sharper than FL_FLOES_SHARP_ANGLE is cut by a side of FL_FLOES_MIN_SIDE times that
 *    radius, normal to the bisector; the inset compensates the lost area.
 *  - A small cell keeps FL_FLOES_MIN_CORE of the inscribed radius that it has beyond the dilation radius: the
 *    inset of its floe is limited. */
#ifndef FL_ICE_FLOES_H
#define FL_ICE_FLOES_H
#include <stdint.h>
#include "base/err.h"
#include "ice/power_cells.h"

#define FL_FLOES_SHORT_SIDE 0.1
#define FL_FLOES_MIN_SIDE 0.02
#define FL_FLOES_MIN_CORE 0.1
#define FL_FLOES_SHARP_ANGLE 0.0872664625997165 /* 5 degrees */

/* Floe i has the corners first[i] .. first[i + 1), counter-clockwise. */
typedef struct {
    int32_t n;
    int32_t *first;          /* [n + 1]                                       */
    fl_vec2 *core;           /* [first[n]]                                [m] */
    fl_vec2 *outer;          /* [first[n]] sides of the core moved out by the radius [m] */
    double inset;            /* d                                         [m] */
    int32_t limited;         /* floes with an inset below d */
    int32_t dropped_sides;   /* sides of cells without a side of a floe */
    int32_t blunted_corners; /* corners cut because they were too sharp */
    int32_t shifted_sides;   /* sides that moved farther inward than the inset */
} fl_floes;

/* Shrink cells until the outer polygons cover `concentration` times the area of the cells, to rounding.
 *    concentration  in (0, 1)
 *    radius         dilation radius, >= 0                                                [m]
 *    shift          added to all corners                                                 [m]
 * The covered area decreases with d and is convex in d; d is bracketed and found by Newton's method.
 * Returns 0, or -1 with FL_INPUT (a cell is too small for the radius, with the largest radius in the
 * message; or the concentration is out of reach of the cells), FL_NUMERIC (sides and inset do not
 * converge) or FL_SYSTEM; out is unchanged then. */
int fl_floes_make(fl_floes *out, const fl_power_cells *cells, double concentration, double radius,
                  fl_vec2 shift, fl_err *err);

/* The same with a concentration for each cell: the outer polygon of floe i covers the fraction part[i], in
 * (0, 1), of its cell with an inset of its own; out->inset is the mean.  A limited floe covers too much;
 * one factor scales the fractions of the others, so that the total is the requested one.
 *    *off  out: largest error of the fraction of a floe that is not limited
 * Returns as above; also FL_INPUT if a fraction is so near to 1 that dropped short sides leave less. */
int fl_floes_make_graded(fl_floes *out, const fl_power_cells *cells, const double *part, double radius,
                         fl_vec2 shift, double *off, fl_err *err);

/* Floes without gaps: the outer polygons are the cells.  A side moves inward if it is shorter than
 * FL_FLOES_FILL_SIDE times the inscribed radius of the core or would vanish on the way to the core, until
 * the side of the core has that length; this leaves a sliver of the cell uncovered.  With a radius of 0
 * only such sides lose area.  Returns 0, or -1 with FL_INPUT (a cell is too small for the radius) or
 * FL_SYSTEM; out is unchanged then. */
#define FL_FLOES_FILL_SIDE 1e-4
int fl_floes_fill(fl_floes *out, const fl_power_cells *cells, double radius, fl_vec2 shift, fl_err *err);

/* Remove the floes with gone[i] set.  name[i], the cell of floe i, is moved along. */
void fl_floes_remove(fl_floes *a, const char *gone, int32_t *name);

void fl_floes_free(fl_floes *a); /* accepts a zeroed struct, leaves a zeroed one */

#endif
