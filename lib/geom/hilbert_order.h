/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hilbert_order.h -- points of the plane in the order in which Hilbert's curve passes them: what is near in the
 * order is near in the plane, and most of what is near in the plane is near in the order.  Work that goes
 * through a million neighbourhoods in this order finds each where the one before has left it, in the cache.
 */
#ifndef FL_GEOM_HILBERT_ORDER_H
#define FL_GEOM_HILBERT_ORDER_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* Place of the square (x, y) of a grid of 2^16 x 2^16 along Hilbert's curve, which begins in the corner (0,
 * 0) and ends in (2^16 - 1, 0); squares that follow each other have a side in common. Source: Hilbert, Math.
 * Ann. 38 (1891) 459. */
uint32_t fl_hilbert_index(uint32_t x, uint32_t y);

/* The points x[n], finite, by their place on a curve through the square over their box; those in one square
 * of its grid by their number.  O(n). order[n]  out: the number of the k-th point Returns 0, or -1 with
 * FL_SYSTEM in err. */
int fl_hilbert_order(int32_t n, const fl_vec2 *x, int32_t *order, fl_err *err);

#endif
