/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_sizing.h -- floes of prescribed sizes (--sizes): their number, the area of each, and the achieved
 * distribution. */
#ifndef VORONOI_ICE_FLOE_SIZING_H
#define VORONOI_ICE_FLOE_SIZING_H
#include "ice/floes.h"
#include "ice/sizes.h"
#include "certificate_table.h"
#include "recipe.h"

struct floe_sizing {
    fl_sizes law;
    double mean;   /* area of a floe: concentration x area of the field / number                [m2] */
    double factor; /* on lengths, by which the sizes were scaled; NAN: the law has no scale          */
    double *area;  /* [floes] requested area of floe i                                          [m2] */
    double min_diameter, max_diameter; /* requested                                              [m] */
    double *achieved;                  /* [floes] areas, ascending                              [m2] */
    double max_error;                  /* largest |achieved - requested| / requested                 */
    double largest_missed;             /* largest requested area among the floes that missed    [m2] */
    int32_t n_missed;                  /* floes with an error above FLOE_SIZING_MISSED               */
};

/* A floe with a larger error counts as missed; smaller errors move no distribution by 0.01. */
#define FLOE_SIZING_MISSED 0.01

/* Read the sizes, if they are in a file, and set open values of the recipe.  Without --floes the number is
 * that of the list, or that which a law with a scale needs for the concentration.  Without --floes and
 * --concentration a list is taken unscaled.  area is that of the field [m2]. The rank of the size of floe
 * i is the rank of a random number of i among those of all floes. Returns 0, or -1 with FL_INPUT (the
 * sizes do not fit the field) or FL_SYSTEM. */
int floe_sizing_assign(struct floe_sizing *s, struct recipe *o, double area, fl_err *err);

/* Measure the floes. */
int floe_sizing_measure(struct floe_sizing *s, const fl_floes *floes, fl_err *err);

/* Add the rows of the sizes to the certificate.  inset: half of the gap between two floes [m]. */
void floe_sizing_certify(const struct floe_sizing *s, const struct recipe *o, double inset,
                         struct certificate_table *t);

void floe_sizing_free(struct floe_sizing *s); /* accepts a zeroed struct, leaves a zeroed one */

#endif
