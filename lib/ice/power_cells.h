/* SPDX-License-Identifier: GPL-3.0-or-later */
/* power_cells.h -- Voronoi and power cells of sites in a convex region of the plane.
 *
 * A Voronoi cell is the set of points nearer to its site than to any other (Okabe, Boots, Sugihara & Chiu,
 * Spatial Tessellations, 2000, ch.  2).  With weights w_i the power |x - x_i|^2 - w_i replaces the squared
 * distance (Laguerre cells; Aurenhammer, SIAM J. Comput.  16 (1987) 78). */
#ifndef FL_ICE_POWER_CELLS_H
#define FL_ICE_POWER_CELLS_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* Cell i has the sides first[i] .. first[i + 1); sides and corners v are counter-clockwise. side.tag is
 * the site across that side, or the wall: that of fl_polygon_rectangle(), or -5 - k for side k of an
 * outline.  The two sides of a common edge have the same numbers with opposite signs.  Where four sites
 * lie on one circle, a side of the length of rounding errors may exist in one of the two cells only. */
typedef struct {
    int32_t n;
    int32_t *first;        /* [n + 1]        */
    fl_polygon_side *side; /* [first[n]] [m] */
    fl_vec2 *v;            /* [first[n]] [m] */
} fl_power_cells;

/* Region: the rectangle lo .. hi, or, if n > 0, the convex polygon v[n], counter-clockwise, with that
 * bounding box. */
typedef struct {
    fl_vec2 lo, hi; /* [m] */
    int32_t n;
    const fl_vec2 *v; /* [n] borrowed [m] */
} fl_outline;

double fl_outline_area(const fl_outline *a);
/* 1 if p is inside and at least `within` [m] away from the outline. */
int fl_outline_contains(const fl_outline *a, fl_vec2 p, double within);

/* Site i of a seed, uniform in the rectangle, independent of the number of sites. */
void fl_random_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site);
/* The same in an outline: the first of its random points inside. */
void fl_random_sites_in_outline(int32_t n, uint64_t seed, const fl_outline *in, fl_vec2 *site);

/* Voronoi cells of site[n], all inside the rectangle lo .. hi.  Returns 0, or -1 with FL_INPUT (two sites
 * coincide) or FL_SYSTEM; out is unchanged then. */
int fl_power_cells_build(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                         fl_err *err);
/* The same in an outline. weight[n] [m2] may be NULL; with weights a cell may be empty (no sides). */
int fl_power_cells_build_in(fl_power_cells *out, int32_t n, const fl_vec2 *site, const double *weight,
                            const fl_outline *in, fl_err *err);

/* One step of Lloyd's smoothing: each site moves to the centroid of its cell.  Source: Lloyd, IEEE Trans.
 * Inf.  Theory 28 (1982) 129; Du, Faber & Gunzburger, SIAM Rev.  41 (1999) 637. */
void fl_power_cells_centroids(const fl_power_cells *c, fl_vec2 *site);

void fl_power_cells_areas(const fl_power_cells *c, double *area); /* [n], 0 for an empty cell [m2] */

void fl_power_cells_free(fl_power_cells *c); /* accepts a zeroed struct, leaves a zeroed one */

#endif
