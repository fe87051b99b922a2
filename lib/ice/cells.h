/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cells.h -- a rectangle divided among sites: to each the part that is nearer to it than to any other
 * (Voronoi; Okabe, Boots, Sugihara & Chiu, Spatial Tessellations, 2000, ch. 2). */
#ifndef FL_ICE_CELLS_H
#define FL_ICE_CELLS_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* Cell i has the sides first[i] .. first[i + 1); they and the corners v run counter-clockwise.  side.tag is
 * the site across that side, or the wall of fl_polygon_rectangle().  The two sides of a shared edge hold the
 * same numbers with opposite signs.  Where four sites lie on one circle, a side as short as rounding may be
 * there for one of the two cells only. */
typedef struct {
    int32_t n;
    int32_t *first; /* [n + 1]        */
    fl_side *side;  /* [first[n]] [m] */
    fl_vec2 *v;     /* [first[n]] [m] */
} fl_cells;

/* Site i of a seed, uniform in the rectangle; it does not depend on how many there are. */
void fl_cells_sites(int32_t n, uint64_t seed, fl_vec2 lo, fl_vec2 hi, fl_vec2 *site);

/* Divide the rectangle lo .. hi among site[n], all inside it.
 * Returns 0, or -1 with FL_INPUT (two sites coincide) or FL_SYSTEM; out is untouched then. */
int fl_cells_build(fl_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi, fl_err *err);

/* One step of Lloyd's smoothing: each site goes to the centroid of its cell.  Source: Lloyd, IEEE Trans.
 * Inf. Theory 28 (1982) 129; Du, Faber & Gunzburger, SIAM Rev. 41 (1999) 637. */
void fl_cells_centroids(const fl_cells *c, fl_vec2 *site);

void fl_cells_free(fl_cells *c); /* accepts a zeroed struct, leaves one */

#endif
