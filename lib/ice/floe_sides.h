/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_sides.h -- which sides of its cell a floe has at an inset, and how far in they lie: those that are
 * long enough on its core, and others where the corner that they would leave comes too near to the cell
 * (floes.h). */
#ifndef FL_ICE_FLOE_SIDES_H
#define FL_ICE_FLOE_SIDES_H
#include "ice/power_cells.h"

/* For one floe after the other, so that a thread stays in its cache; with room for the cell that has most
 * sides. */
typedef struct {
    fl_polygon_side *moved, *kept; /* the cell's sides as moved, and those of the core */
    fl_vec2 *corner;
    unsigned char *state;
} fl_floe_scratch;

/* Everything by side lies at the cells' own offsets. */
typedef struct {
    const fl_power_cells *cells;
    double radius;
    double short_side,
        min_side; /* FL_FLOES_SHORT_SIDE and FL_FLOES_MIN_SIDE, or FL_FLOES_FILL_SIDE for both             */
    const double
        *own_inset; /* [n] insets of the floes, NULL when they have a common one                  [m] */
    double *inradius, *max_inset; /* [n] of the cell, and the largest inset it may have            [m] */
    double *area, *perimeter;     /* [n] of the outer polygon at the inset last asked for     [m2, m] */
    int32_t *count;               /* [n] sides of the floe                                            */
    fl_polygon_side *side;        /* sides of the floe; tag is the place in the cell                  */
    fl_floe_scratch *scratch;     /* [threads]                                                        */
    int threads;
    double sharp_cot;        /* cot(t / 2) for the angle t below which corners are cut off; 0: none are */
    int32_t blunted_corners; /* corners cut off                                                  */
} fl_floe_sides;

/* Room for all floes of f->cells.  -1 with FL_SYSTEM; fl_floe_sides_free() in any case. */
int fl_floe_sides_alloc(fl_floe_sides *f, fl_err *err);
void fl_floe_sides_free(fl_floe_sides *f);

/* That of the calling thread. */
const fl_floe_scratch *fl_floe_sides_scratch(const fl_floe_sides *f);

/* The inset of floe i where d is asked for: its own, where it has one, and not more than the most. */
double fl_floe_sides_inset(const fl_floe_sides *f, int32_t i, double d);

/* Choose the sides of floe i for inset d.  Returns -1 when they do not settle. */
int fl_floe_sides_choose(fl_floe_sides *f, int32_t i, double d);

/* Do the sides chosen at another inset serve at this one too? */
int fl_floe_sides_are_valid(fl_floe_sides *f, int32_t i, double d);

#endif
