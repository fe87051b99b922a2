/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hilbert_order.h -- orders points of the plane along a Hilbert curve.  Neighbours in the order are
 * neighbours in the plane, and most neighbours in the plane are close in the order.  Work over many
 * neighbourhoods in this order therefore finds its data in the cache. */
#ifndef FL_GEOM_HILBERT_ORDER_H
#define FL_GEOM_HILBERT_ORDER_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

/* Index of square (x, y) of a 2^16 x 2^16 grid along the Hilbert curve from corner (0, 0) to (2^16 - 1, 0).
 * Consecutive squares share a side.  Source: Hilbert, Math. Ann. 38 (1891) 459. */
uint32_t fl_hilbert_index(uint32_t x, uint32_t y);

/* Index of cube (x, y, z) of a 2^21 grid along the Hilbert curve in space; consecutive cubes share a face.
 * Source: Skilling, AIP Conf. Proc. 707 (2004) 381. */
uint64_t fl_hilbert_index3(uint32_t x, uint32_t y, uint32_t z);

/* Sorts the finite points x[n] along the curve over the square around them; points in one grid square by
 * number.  O(n).
 *   order[n]  out: the number of the k-th point
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_hilbert_order(int32_t n, const fl_vec2 *x, int32_t *order, fl_err *err);

#endif
