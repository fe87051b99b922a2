/* SPDX-License-Identifier: GPL-3.0-or-later */
/* floe_thickness.h -- how thick each floe is and how deep it floats. */
#ifndef VORONOI_ICE_FLOE_THICKNESS_H
#define VORONOI_ICE_FLOE_THICKNESS_H
#include "ice/thickness.h"
#include "certificate_table.h"
#include "options.h"

struct depth {
    fl_thickness law;
    double least;                       /* what a floe must be thicker than                       [m] */
    double ratio;                       /* of the draft to the thickness                              */
    double most;                        /* the largest of ids 0 .. 2 floes, or of the law when known [m] */
    int32_t n;                          /* measured floes                                             */
    double mean, thin, thick, distance; /* [m], and the Kolmogorov-Smirnov distance          */
    int64_t again;                      /* numbers that were too small                                */
    double volume;                      /* of the ice [m3] */
};

/* Read the law.  Returns 0, or -1 with FL_USAGE, FL_INPUT (the file; all of the law is too thin for the
 * dilation radius) or FL_SYSTEM. */
int depth_make(struct depth *d, struct options *o, fl_err *err);

/* The thickness of the floe with that id [m]. */
double depth_of(const struct depth *d, const struct options *o, int32_t id);

/* Measure n floes by their ids; area[n] [m2].  Returns 0, or -1 with FL_SYSTEM. */
int depth_measure(struct depth *d, const struct options *o, int32_t n, const int32_t *id, const double *area,
                  fl_err *err);

void depth_certify(const struct depth *d, const struct options *o, struct certify *t);

void depth_free(struct depth *d); /* accepts a zeroed struct, leaves one */

#endif
