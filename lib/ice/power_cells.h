/* SPDX-License-Identifier: GPL-3.0-or-later */
/* power_cells.h -- a convex piece of the plane divided among sites: to each the part that is nearer to it than to
 * any other (Voronoi; Okabe, Boots, Sugihara & Chiu, Spatial Tessellations, 2000, ch. 2), or, with weights,
 * of less power (Laguerre; Aurenhammer, SIAM J. Comput. 16 (1987) 78). */
#ifndef FL_ICE_POWER_CELLS_H
#define FL_ICE_POWER_CELLS_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* Cell i has the sides first[i] .. first[i + 1); they and the corners v run counter-clockwise.  side.tag is
 * the site across that side, or the wall: that of fl_polygon_rectangle(), or -5 - k for side k of an outline.
 * The two sides of a shared edge hold the same numbers with opposite signs.  Where four sites lie on one
 * circle, a side as short as rounding may be there for one of the two cells only. */
typedef struct {
    int32_t n;
    int32_t *first;        /* [n + 1]        */
    fl_polygon_side *side; /* [first[n]] [m] */
    fl_vec2 *v;            /* [first[n]] [m] */
} fl_power_cells;

/* What is divided: the rectangle lo .. hi, or, with n > 0, the convex polygon v[n], counter-clockwise, of
 * which it is the box. */
typedef struct {
    fl_vec2 lo, hi; /* [m] */
    int32_t n;
    const fl_vec2 *v; /* [n] borrowed [m] */
} fl_outline;

double fl_outline_area(const fl_outline *a);
/* 1 when p lies inside, at least `within` [m] away from the outline. */
int fl_outline_contains(const fl_outline *a, fl_vec2 p, double within);

/* Site i of a seed, uniform in the rectangle; it does not depend on how many there are. */
void fl_random_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site);
/* The same in an outline: the first of its numbers that lies inside. */
void fl_random_sites_in_outline(int32_t n, uint64_t seed, const fl_outline *in, fl_vec2 *site);

/* Divide the rectangle lo .. hi among site[n], all inside it.
 * Returns 0, or -1 with FL_INPUT (two sites coincide) or FL_SYSTEM; out is untouched then. */
int fl_power_cells_build(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                         fl_err *err);
/* The same for an outline.  weight[n] [m2] may be NULL; with weights a cell may be empty (no sides). */
int fl_power_cells_build_in(fl_power_cells *out, int32_t n, const fl_vec2 *site, const double *weight,
                            const fl_outline *in, fl_err *err);

/* One step of Lloyd's smoothing: each site goes to the centroid of its cell.  Source: Lloyd, IEEE Trans.
 * Inf. Theory 28 (1982) 129; Du, Faber & Gunzburger, SIAM Rev. 41 (1999) 637. */
void fl_power_cells_centroids(const fl_power_cells *c, fl_vec2 *site);

void fl_power_cells_areas(const fl_power_cells *c, double *area); /* [n], 0 for an empty one [m2] */

void fl_power_cells_free(fl_power_cells *c); /* accepts a zeroed struct, leaves one */

#endif
