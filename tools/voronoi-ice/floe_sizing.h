/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_sizing.h -- floes of asked sizes: how many, which one gets which, and how near the field has come. */
#ifndef VORONOI_ICE_FLOE_SIZING_H
#define VORONOI_ICE_FLOE_SIZING_H
#include "ice/power_cells.h"
#include "ice/floes.h"
#include "ice/sizes.h"
#include "certificate_table.h"
#include "options.h"

struct sizing {
    fl_sizes law;
    double mean;        /* area of a floe, concentration times the area of the field over the number   [m2] */
    double factor;      /* on lengths, by which the sizes asked for were scaled; NAN: they had no scale     */
    double *area;       /* [floes] asked of floe i                                                     [m2] */
    double least, most; /* diameters asked of the smallest and the largest [m] */
    double *got;        /* [floes] ascending, achieved                                                 [m2] */
    double worst;       /* largest |achieved - asked| / asked                                               */
    double largest_missed; /* area asked of the largest of those that missed [m2] */
    int32_t missed; /* floes off by more than SIZING_MISSED of what was asked                           */
};

/* A floe off by more than this counts as missed: what is wrong by less moves no distribution by 0.01. */
#define SIZING_MISSED 0.01

/* Read the sizes asked for, when they are in a file, and settle what was left open: without --floes there are
 * as many as a list has, or as a law that has a scale needs to cover the concentration; without both --floes
 * and --concentration a list is taken as it is.  The area is that of the field [m2].
 * Floe i gets the size whose rank is that of a random number of i among those of all.
 * Returns 0, or -1 with FL_INPUT (the sizes do not fit the field) or FL_SYSTEM. */
int sizing_ask(struct sizing *s, struct options *o, double area, fl_err *err);

/* Measure the floes. */
int sizing_measure(struct sizing *s, const fl_floes *floes, fl_err *err);

/* inset: of the cells, half of the gap between two floes [m] */
void sizing_certify(const struct sizing *s, const struct options *o, double inset, struct certify *t);

void sizing_free(struct sizing *s); /* accepts a zeroed struct, leaves one */

#endif
