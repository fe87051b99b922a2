/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pair_gap.h -- two floes with a known gap cannot touch before it is used up.
 *
 * fl_pair.free_travel bounds that by the paths of both, so it ends soon where floes drift or slide side by
 * side.  Here it is bounded by their poses.  Planes across the axis of the pair, which is fixed in j, leave a
 * gap between the cores: D0 at first and then at least
 *     D0 + n0.y0 - n.y - rho |k - k0|
 *   n    the axis, from j to i, world axes;  k  in the axes of i
 *   y    from the centre of i to that of j
 *   rho  bounding radius of i: its lowest vertex along k cannot sink by more
 * Pairs with a piece of the structure, which may change its shape, are left out, and those of floes that may
 * sleep, whose positions need not be those of now. */
#ifndef FL_CONTACT_PAIR_GAP_H
#define FL_CONTACT_PAIR_GAP_H
#include "world/world.h"

/* Stores the gap of near pair q, just evaluated, from its free travel and axis; or that none is known. */
void fl_pair_store_gap(const fl_world *w, fl_neighbour_pair *q);

static inline int fl_gap_is_known(const fl_known_gap *g)
{
    return g->k[0] != 0.0f || g->k[1] != 0.0f || g->k[2] != 0.0f;
}

/* True if near pair c, whose gap is known, cannot touch in its present pose.  Its free travel is then that of
 * the gap from now on. */
int fl_pair_keeps_gap(fl_world *w, int32_t c);

#endif
