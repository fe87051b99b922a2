/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floes.h -- from cells that fill a rectangle to floes that cover a given part of it.
 *
 * The sides of every cell move inward by one common distance, the inset d; what is left is the floe as the
 * water sees it (the outer polygon).  Moved inward by the radius once more it is the core that is written.
 * Dilating the core's sides gives the outer polygon back (what is asked for is outer sizes, voronoi-ice(1)),
 * so both must have the same sides: the fit of a floe sees to that.
 *   - A side that vanishes between outer polygon and core, or is left shorter than FL_FLOES_SHORT_SIDE times the
 *     core's inscribed radius, is dropped, where the sharper corner that this leaves stays inside the cell
 *     with half the inset to spare.
 *   - Where it does not, the side is kept and moves in farther, until the core's side is FL_FLOES_MIN_SIDE times
 *     that radius long (less at a blunt corner, so that the inscribed circle is never cut).
 *   - A corner of the core sharper than FL_FLOES_SHARP_ANGLE is cut off by a side of FL_FLOES_MIN_SIDE times that
 *     radius, square to the bisector; what the outer polygons lose there, the inset gives back.
 * A small cell keeps FL_FLOES_MIN_CORE of the inscribed radius that it has to spare over the dilation radius: its
 * floe is inset less than the others ("held"). */
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
    fl_vec2 *outer;          /* [first[n]] the core's sides moved out by the radius [m] */
    double inset;            /* d                                         [m] */
    int32_t limited;         /* floes inset by less than d               */
    int32_t dropped_sides;   /* sides of cells that have no side of a floe */
    int32_t blunted_corners; /* corners cut off since they were too sharp */
    int32_t shifted_sides;   /* sides that moved in by more than their floe */
} fl_floes;

/* Shrink cells until the outer polygons cover  concentration  times the area of the cells, to rounding.
 *   concentration  in (0, 1)
 *   radius         dilation radius, >= 0                                                  [m]
 *   shift          added to all corners                                                   [m]
 * The covered area falls with d and is convex in d; d is bracketed and found by Newton's steps.
 * Returns 0, or -1 with FL_INPUT: a cell is too small for the radius (which one, and how large the radius may
 * be), or the concentration lies outside what the cells can give; FL_NUMERIC: sides and inset did not settle;
 * FL_SYSTEM.  out is untouched then. */
int fl_floes_make(fl_floes *out, const fl_power_cells *cells, double concentration, double radius,
                  fl_vec2 shift, fl_err *err);

/* The same with a concentration for each cell: the outer polygon of floe i covers part[i], in (0, 1), of its
 * cell, and each has an inset of its own; that of out is the mean.  A held floe covers more than it should:
 * the parts of the others are scaled by one factor, so that all together cover what all were asked for.
 *   *off  out: largest difference of a part that a floe not held covers and what was asked
 * Returns as above; also FL_INPUT when a part is so near to 1 that short sides leave less. */
int fl_floes_make_graded(fl_floes *out, const fl_power_cells *cells, const double *part, double radius,
                         fl_vec2 shift, double *off, fl_err *err);

/* Floes without gaps: the outer polygons are the cells.  A side shorter than FL_FLOES_FILL_SIDE times the
 * inscribed radius of the core, or one that would vanish on the way to the core, moves in until the core's
 * side is that long, and leaves a sliver of the cell uncovered; with a radius of 0 nothing is lost but such
 * sides.
 * Returns 0, or -1 with FL_INPUT: a cell is too small for the radius; FL_SYSTEM.  out is untouched then. */
#define FL_FLOES_FILL_SIDE 1e-4
int fl_floes_fill(fl_floes *out, const fl_power_cells *cells, double radius, fl_vec2 shift, fl_err *err);

/* Drop the floes with gone[i] set.  name[i], the cell of floe i, is kept in step. */
void fl_floes_remove(fl_floes *a, const char *gone, int32_t *name);

void fl_floes_free(fl_floes *a); /* accepts a zeroed struct, leaves one */

#endif
