/* SPDX-License-Identifier: GPL-3.0-or-later */
/* descent.h -- the first stage of the distance of two convex cores: GJK's walk from simplex to simplex,
 * in doubles. */
#ifndef FL_NARROW_DESCENT_H
#define FL_NARROW_DESCENT_H
#include "narrow/gjk.h"

/* Rounding of a comparison of two support heights: the dot product of a unit vector and a difference has an
 * error of at most 3 units of 2^-53 of the extent, on either core. */
#define FL_SUPPORT_ROUNDING (8.0 * 2.220446049250313e-16)

/* Below this fraction of the extent the walk hands over to pairs of doubles.  The nearest point v of a
 * simplex of extent E carries a rounding of a few 2^-53 E, so its direction one of a few 2^-53 E / d: at
 * 1e-4 E some 1e-12 rad. */
#define FL_FINE_BELOW 1e-4

/* Up to four vertex differences w[k] = a.v[a[k]] - b.v[b[k]], each pair once. */
typedef struct {
    int32_t n, a[4], b[4];
    fl_vec3 w[4];
} fl_simplex;

/* Largest distance of a vertex from vertex 0 [m]. */
double fl_core_extent(fl_core c);

/* The vertex lowest along dir, the first of equals; *low is dir.(v - v[0]) of it.  Differences come first, so
 * that nothing is lost far from the origin. */
int32_t fl_core_lowest(fl_core c, fl_vec3 dir, double *low);

/* The simplex to start from: the pairs of the cache as far as they exist, or vertex 0 of each; never
 * empty. */
void fl_simplex_start(fl_simplex *s, fl_core a, fl_core b, const fl_gjk_cache *cache);

/* Does the list hold the pair (i, j)? */
int fl_simplex_has(int32_t n, const int32_t *a, const int32_t *b, int32_t i, int32_t j);

/* From simplex s to the nearest point *v of hull(a) - hull(b) to the origin; s ends as the points that
 * carry it.
 *   size    sum of the extents                                                                  [m]
 *   steps   counts the supports
 * Returns 1; or 0 when doubles cannot tell: the cores may meet, are nearer than FL_FINE_BELOW size, or there
 * was no end after 64 supports.  s is good to go on from either way. */
int fl_descend(fl_core a, fl_core b, double size, fl_simplex *s, fl_vec3 *v, int32_t *steps);

#endif
