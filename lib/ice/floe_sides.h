/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_sides.h -- selection of the sides of a floe at a given inset (floes.h).
 *
 * A floe keeps a side of its cell if the side is long enough on the core.  It keeps other sides, moved
 * farther inward, where dropping them would leave a corner too near to the cell. */
#ifndef FL_ICE_FLOE_SIDES_H
#define FL_ICE_FLOE_SIDES_H
#include "ice/power_cells.h"

/* Scratch of one thread, reused for one floe after the other, with room for the cell with most sides. */
typedef struct {
    fl_polygon_side *moved, *kept; /* sides of the cell, moved; sides of the core */
    fl_vec2 *corner;
    unsigned char *state;
} fl_floe_scratch;

/* Arrays by side use the offsets of the cells. */
typedef struct {
    const fl_power_cells *cells;
    double radius;
    double short_side,
        min_side;            /* FL_FLOES_SHORT_SIDE and FL_FLOES_MIN_SIDE, or FL_FLOES_FILL_SIDE for both */
    const double *own_inset; /* [n] inset of each floe, NULL for a common one [m] */
    double *inradius, *max_inset; /* [n] of the cell; largest inset of the floe [m] */
    double *area, *perimeter;     /* [n] of the outer polygon at the inset of the last evaluation [m2, m] */
    int32_t *count;               /* [n] sides of the floe                                            */
    fl_polygon_side *side;        /* sides of the floe; tag is the index in the cell */
    fl_floe_scratch *scratch;     /* [threads]                                                        */
    int threads;
    double sharp_cot;        /* cot(t / 2) of the angle t below which corners are cut; 0: none */
    int32_t blunted_corners; /* corners that are cut */
} fl_floe_sides;

/* Allocate for all floes of f->cells.  Returns 0, or -1 with FL_SYSTEM; call fl_floe_sides_free() in any
 * case. */
int fl_floe_sides_alloc(fl_floe_sides *f, fl_err *err);
void fl_floe_sides_free(fl_floe_sides *f);

/* Scratch of the calling thread. */
const fl_floe_scratch *fl_floe_sides_scratch(const fl_floe_sides *f);

/* Inset of floe i at a common inset d: own_inset, if there is one, and at most max_inset. */
double fl_floe_sides_inset(const fl_floe_sides *f, int32_t i, double d);

/* Select the sides of floe i for inset d.  Returns 0, or -1 if the selection does not converge. */
int fl_floe_sides_choose(fl_floe_sides *f, int32_t i, double d);

/* 1 if the sides selected at another inset are valid at inset d too. */
int fl_floe_sides_are_valid(fl_floe_sides *f, int32_t i, double d);

#endif
