/* SPDX-License-Identifier: GPL-3.0-or-later */
/* open_water.h -- the water that floes may cover: an outline without leads, ridges and structures. */
#ifndef VORONOI_ICE_OPEN_WATER_H
#define VORONOI_ICE_OPEN_WATER_H
#include "ice/domain.h"
#include "ice/power_cells.h"
#include "certificate_table.h"
#include "recipe.h"

/* A piece of a cell is a sliver if the floe in it would have an inscribed radius below this fraction of the
 * square root of the mean area of a cell; that of a mean floe is about half of the square root. */
#define OPEN_WATER_SLIVER 0.15
/* Largest distance of a polygon round a structure from it, over the square root of the mean floe area. */
#define OPEN_WATER_COARSE 0.1

struct open_water {
    int is_domain;      /* 0: the water is the rectangle                                           */
    fl_domain domain;   /* about the origin, see shift                                         [m] */
    fl_vec2 shift;      /* from the origin to the centre of the field                          [m] */
    fl_domain removed;  /* with --sizes, --periodic: rings at their place; floes that meet one are removed */
    double area;        /* open to ice                                                        [m2] */
    int32_t structures; /* connected parts of structures that are kept out                         */
    int32_t *id;        /* [cells] of the pieces, if is_domain                                     */
    double sliver_area; /* [m2] */
    int32_t slivers;    /* pieces that were dropped */
};

/* Build the water from the recipe; an outline sets o->size and o->origin.  The area is not known yet.
 * Floes of prescribed sizes and of periodic fields are not cut: leads, ridges and structures remove them
 * whole.  h: largest thickness of the ice [m].  Returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
int open_water_make(struct open_water *w, struct recipe *o, double h, fl_err *err);

/* The region of sites and power diagrams: the rectangle, or the outline if it is convex and whole. */
fl_outline open_water_outline(const struct open_water *w, const struct recipe *o);

/* 1 if a floe (convex, counter-clockwise, at its place) meets a removed ring. */
int open_water_removes(const struct open_water *w, int32_t n, const fl_vec2 *v);

/* Voronoi cells of random sites, smoothed and cut to the water.  In each smoothing step a site moves to the
 * centroid of the largest piece of its cell.  Sets area, id, sliver_area and slivers.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM; cells is unchanged then. */
int open_water_cells(struct open_water *w, const struct recipe *o, fl_power_cells *cells, fl_err *err);

/* Add the rows of the water to the certificate. */
void open_water_certify(const struct open_water *w, const struct recipe *o, struct certificate_table *t);

void open_water_free(struct open_water *w); /* accepts a zeroed struct, leaves a zeroed one */

#endif
