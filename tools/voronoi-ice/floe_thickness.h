/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_thickness.h -- thickness and draft of the floes of a field. */
#ifndef VORONOI_ICE_FLOE_THICKNESS_H
#define VORONOI_ICE_FLOE_THICKNESS_H
#include "ice/thickness.h"
#include "certificate_table.h"
#include "recipe.h"

struct floe_thickness {
    fl_thickness law;
    double min;               /* a floe must be thicker than this                             [m] */
    double draft_ratio;       /* draft over thickness                                             */
    double max;               /* largest of ids 0 .. 2 floes, or of a constant law            [m] */
    int32_t n;                /* measured floes                                                   */
    double mean;              /*                                                              [m] */
    double smallest, largest; /*                                                              [m] */
    double ks_distance;       /* Kolmogorov-Smirnov distance to the law                           */
    int64_t redraws;          /* draws that were too thin                                         */
    double volume;            /* of the ice                                                  [m3] */
};

/* Read the law.  Returns 0, or -1 with FL_USAGE, FL_INPUT (the file; most of the law is too thin for the
 * dilation radius) or FL_SYSTEM. */
int floe_thickness_read(struct floe_thickness *d, struct recipe *o, fl_err *err);

/* Thickness of the floe with that id [m]. */
double floe_thickness_at(const struct floe_thickness *d, const struct recipe *o, int32_t id);

/* Compute the statistics of n floes with these ids; area[n] [m2].  Returns 0, or -1 with FL_SYSTEM. */
int floe_thickness_measure(struct floe_thickness *d, const struct recipe *o, int32_t n, const int32_t *id,
                           const double *area, fl_err *err);

/* Add the rows of thickness and draft to the certificate. */
void floe_thickness_certify(const struct floe_thickness *d, const struct recipe *o,
                            struct certificate_table *t);

void floe_thickness_free(struct floe_thickness *d); /* accepts a zeroed struct, leaves a zeroed one */

#endif
