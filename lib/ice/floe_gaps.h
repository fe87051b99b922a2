/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_gaps.h -- gaps between floes: random ones, and their distribution.
 *
 * Floes made by an inset of their cells have the same gap everywhere, twice the inset; no drifting ice has.
 * Pushed, each floe moves along a random direction u until it touches a side of its own cell: with the slack
 * g_k of side k, the distance from the floe to it, and its normal n_k, by
 *     t = (1 - 1e-6) min g_k / (n_k . u)   over the sides with n_k . u > 0,
 * so floes never overlap, and areas and concentration stay.  Two floes touch where both have moved to their
 * common side: about one floe in five touches another, the others have open water of
 * all widths up to four insets.
 *
 * The gap across a side that two cells share is the sum of the slacks on both of its sides. */
#ifndef FL_ICE_FLOE_GAPS_H
#define FL_ICE_FLOE_GAPS_H
#include "ice/floes.h"

/* Push every floe; floe i is in cell i.  The direction of floe i depends on seed and i alone.
 *   shift  what was added to the corners of the cells [m] */
void fl_floes_push(fl_floes *a, const fl_power_cells *cells, fl_vec2 shift, uint64_t seed);

typedef struct {
    double median, q90; /* gaps across common sides [m] */
    double touching;    /* fraction of floes with a gap below a hundredth of twice the inset */
} fl_floe_gaps;

/* 0, or -1 with FL_SYSTEM in err. */
int fl_floe_gaps_measure(fl_floe_gaps *g, const fl_floes *a, const fl_power_cells *cells, fl_vec2 shift,
                         fl_err *err);

#endif
