/* SPDX-License-Identifier: GPL-3.0-or-later */
/* periodic.h -- Voronoi cells of a periodic field, whose copies fit side by side without a seam. */
#ifndef FL_ICE_PERIODIC_H
#define FL_ICE_PERIODIC_H
#include <stdint.h>
#include "base/err.h"
#include "ice/power_cells.h"

/* Voronoi cells of site[n], all inside the rectangle lo .. hi, which is periodic along x, y or both.  A
 * cell lies about its own site and may extend beyond the rectangle; its copy one period away then covers
 * the opposite side.  The tag of a side is the site across it, in any copy.  Copies of the sites are added
 * in a band round the rectangle.  The band is wide enough if each corner of a cell is farther inside the
 * band than from its site: then it contains all sites that could be nearer to the corner.
 *    periodic  along x, along y
 * Cost n log n.  Returns 0, or -1 with FL_INPUT (two sites coincide) or FL_SYSTEM; out is unchanged then. */
int fl_periodic_cells(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                      const int periodic[2], fl_err *err);

/* Move p into lo .. hi along the periodic directions. */
fl_vec2 fl_periodic_wrap(fl_vec2 p, fl_vec2 lo, fl_vec2 hi, const int periodic[2]);

#endif
