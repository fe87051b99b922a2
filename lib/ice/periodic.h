/* SPDX-License-Identifier: GPL-3.0-or-later */
/* periodic.h -- cells of a field that repeats itself: laid side by side its copies fit without a seam. */
#ifndef FL_ICE_PERIODIC_H
#define FL_ICE_PERIODIC_H
#include <stdint.h>
#include "base/err.h"
#include "ice/power_cells.h"

/* Divide the rectangle lo .. hi among site[n], all inside it, where along x, y or both whatever leaves at one
 * side comes in at the other.  A cell lies about its own site and may stand out of the rectangle; where it
 * does, its copy one period away fills the place on the other side.  A tag of a side is the site across it,
 * whichever copy.  Copies of sites are laid round the rectangle in a band that is wide enough: each corner of
 * a cell must lie farther inside the band than from its site, for then all sites that could be nearer to it
 * were there.
 *   periodic  along x, along y
 * Returns 0, or -1 with FL_INPUT (two sites coincide) or FL_SYSTEM; out is untouched then.  n log n. */
int fl_periodic_cells(fl_power_cells *out, int32_t n, const fl_vec2 *site, fl_vec2 lo, fl_vec2 hi,
                      const int periodic[2], fl_err *err);

/* Bring p back into lo .. hi along the periodic directions. */
fl_vec2 fl_periodic_wrap(fl_vec2 p, fl_vec2 lo, fl_vec2 hi, const int periodic[2]);

#endif
