/* SPDX-License-Identifier: GPL-3.0-or-later */
/* open_water.h -- the water that floes are to cover, as the options say: an outline, leads, structures. */
#ifndef VORONOI_ICE_OPEN_WATER_H
#define VORONOI_ICE_OPEN_WATER_H
#include "ice/power_cells.h"
#include "ice/domain.h"
#include "certificate_table.h"
#include "options.h"

/* Pieces of cells with an inscribed circle smaller than this part of the root of a floe's area are slivers;
 * that of a mean round floe is half of it. */
#define WATER_SLIVER 0.1
/* A polygon round a structure may stand off from it by this part of the root of a floe's area. */
#define WATER_COARSE 0.1

struct water {
    int on;         /* 0: it is the rectangle */
    fl_domain d;    /* about the origin, see middle           */
    fl_vec2 shift;  /* to where it lies                   [m] */
    fl_domain gone; /* with --sizes: convex rings, where they lie; floes that meet one are taken out */
    double area;    /* open to ice                       [m2] */
    int32_t kept;   /* groups of structures that it leaves out */
    int32_t *id;    /* [cells] of the pieces, when on          */
    double lost;    /* slivers                           [m2] */
    int32_t dropped;
};

/* Read and put together what the options name; an outline settles o->size and o->origin.  The area is not
 * known yet.  Floes of given sizes are not cut: leads, ridges and structures take them out whole.  h is how
 * thick the ice is at most [m].  Returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
int water_make(struct water *w, struct options *o, double h, fl_err *err);

/* What sites and power diagrams are made in: the rectangle, or the outline when it is convex and whole. */
fl_outline water_outline(const struct water *w, const struct options *o);

/* 1 when a floe, convex, counter-clockwise and where it lies, meets what is taken out. */
int water_takes(const struct water *w, int32_t n, const fl_vec2 *v);

/* Voronoi cells of random sites, smoothed, cut down to the water: every site moves to the centroid of the
 * largest piece of its cell.  Settles area, id, lost and dropped.  Returns 0, or -1 with FL_INPUT or
 * FL_SYSTEM; cells is untouched then. */
int water_cells(struct water *w, const struct options *o, fl_power_cells *cells, fl_err *err);

void water_certify(const struct water *w, const struct options *o, struct certify *t);

void water_free(struct water *w); /* accepts a zeroed struct, leaves one */

#endif
