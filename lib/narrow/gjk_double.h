/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk_double.h -- the first stage of the distance of two convex cores: GJK's walk from simplex to simplex,
 * in doubles. */
#ifndef FL_NARROW_GJK_DOUBLE_H
#define FL_NARROW_GJK_DOUBLE_H
#include "narrow/simplex.h"

/* Rounding of a comparison of two support heights: the dot product of a unit vector and a difference has an
 * error of at most 3 units of 2^-53 of the extent, on either core. */
#define FL_SUPPORT_ROUNDING (8.0 * 2.220446049250313e-16)

/* Below this fraction of the extent the walk hands over to pairs of doubles.  The nearest point v of a
 * simplex of extent E carries a rounding of a few 2^-53 E, so its direction one of a few 2^-53 E / d: at
 * 1e-4 E some 1e-12 rad. */
#define FL_GJK_DD_BELOW 1e-4

/* Cores of up to this many vertices are looked at whole. */
enum { FL_CORE_SMALL = 64 };

/* The length of a core to which rounding is relative [m]: its body's size, or the largest distance of a
 * vertex from vertex 0. */
double fl_core_extent(fl_core c);

/* The vertex lowest along dir, the first of equals; *low is dir.(v - v[0]) of it.  Differences come first, so
 * that nothing is lost far from the origin. */
int32_t fl_core_support(fl_core c, fl_vec3 dir, double *low);

/* The same for cores of more than FL_CORE_SMALL vertices that know their edges: downhill from vertex `from`,
 * to where no neighbour is lower; of equals any.  On others as fl_core_support(). */
int32_t fl_core_hill_climb(fl_core c, fl_vec3 dir, int32_t from, double *low);

/* Heights dir.(v - v[0]) of the vertices of a core along the last direction looked at, where it has at most
 * FL_CORE_SMALL vertices. */
typedef struct {
    double low, of[FL_CORE_SMALL];
} fl_support_heights;

/* The vertices within band of the lowest along dir, ascending, and above[], how far each is above it. What is
 * below a height is in one piece on a convex body, so where edges are known only that piece and its
 * neighbours are looked at, from vertex `from` on; a little more of it than the band, so that no dent that
 * fl_poly_make() lets pass hides a lower vertex. h      heights along dir, or NULL clear  out: no vertex is
 * as near as this to the border of the band                         [m] Returns how many, or FL_CORE_SMALL +
 * 1 for more than FL_CORE_SMALL, and then at and above are not filled. */
int32_t fl_core_support_band(fl_core c, fl_vec3 dir, const fl_support_heights *h, int32_t from, double band,
                             int32_t *at, double *above, double *clear);

/* The simplex to start from: the pairs of the cache as far as they exist, or vertex 0 of each; never
 * empty. */
void fl_simplex_start(fl_simplex *s, fl_core a, fl_core b, const fl_gjk_cache *cache);

/* Does the list hold the pair (i, j)? */
int fl_simplex_has(int32_t n, const int32_t *a, const int32_t *b, int32_t i, int32_t j);

/* From simplex s to the nearest point of hull(a) - hull(b) to the origin; s ends as the points that carry it.
 * size    sum of the extents                                                                  [m] n
 * out: unit vector to that point h[2]    out: heights of a along n, of b along -n steps   counts the supports
 * Returns 1; or 0 when doubles cannot tell: the cores may meet, are nearer than FL_GJK_DD_BELOW size, or
 * there was no end after 64 supports.  s is good to go on from either way. */
int fl_gjk_double(fl_core a, fl_core b, double size, fl_simplex *s, fl_vec3 *n, fl_support_heights *h,
                  int32_t *steps);

#endif
