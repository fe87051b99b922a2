/* SPDX-License-Identifier: GPL-3.0-or-later */
/* gjk_double.h -- first stage of the distance of two convex cores (gjk.h): GJK iterations in doubles, and
 * support points. */
#ifndef FL_NARROW_GJK_DOUBLE_H
#define FL_NARROW_GJK_DOUBLE_H
#include "narrow/simplex.h"

/* Rounding of a comparison of two support heights: the dot product of a unit vector and a difference has an
 * error of at most 3 units of 2^-53 of the extent, on either core. */
#define FL_SUPPORT_ROUNDING (8.0 * 2.220446049250313e-16)

/* Fraction of the extent below which double-doubles take over.  The closest point v of a simplex of extent E
 * has a rounding of a few 2^-53 E, so its direction one of a few 2^-53 E / d: at 1e-4 E about 1e-12 rad. */
#define FL_GJK_DD_BELOW 1e-4

/* Up to this number of vertices every vertex is tested. */
enum { FL_CORE_SMALL = 64 };

/* Length of a core to which rounding is relative [m]: the size of its body, or the largest distance of a
 * vertex from vertex 0. */
double fl_core_extent(fl_core c);

/* The lowest vertex along dir, the first of equals; *low: dir.(v - v[0]) of it.  Differences are taken first,
 * so no digits are lost far from the origin. */
int32_t fl_core_support(fl_core c, fl_vec3 dir, double *low);

/* The same for cores of more than FL_CORE_SMALL vertices with known edges: hill climbing from vertex `from`
 * to one without a lower neighbour; any one of equals.  For other cores as fl_core_support(). */
int32_t fl_core_hill_climb(fl_core c, fl_vec3 dir, int32_t from, double *low);

/* Heights dir.(v - v[0]) of the vertices of a core along the last direction, for at most FL_CORE_SMALL
 * vertices. */
typedef struct {
    double low, of[FL_CORE_SMALL];
} fl_support_heights;

/* The vertices within `band` of the lowest along dir, ascending, and above[], their heights over it.
 *     h      heights along dir, or NULL
 *     clear  out: no vertex is as near as this to the border of the band [m]
 * On a convex body the vertices below a height are connected.  So where edges are known only that part and
 * its neighbours are visited, from vertex `from` on.  The part is a little larger than the band, so that no
 * dent that fl_poly_make() accepts hides a lower vertex. Returns their number, or FL_CORE_SMALL + 1 for more
 * than FL_CORE_SMALL; then at and above are not filled. */
int32_t fl_core_support_band(fl_core c, fl_vec3 dir, const fl_support_heights *h, int32_t from, double band,
                             int32_t *at, double *above, double *clear);

/* The initial simplex: the pairs of the cache that exist, or vertex 0 of each core; never empty. */
void fl_simplex_start(fl_simplex *s, fl_core a, fl_core b, const fl_gjk_cache *cache);

/* True if the list contains the pair (i, j). */
int fl_simplex_has(int32_t n, const int32_t *a, const int32_t *b, int32_t i, int32_t j);

/* Iterates from simplex s to the point of hull(a) - hull(b) closest to the origin; s ends as the vertex
 * differences that carry it.
 *     size    sum of the extents [m]
 *     n       out: unit vector to that point
 *     h[2]    out: heights of a along n, of b along -n
 *     steps   counts the supports
 * Returns 1; or 0 when doubles do not suffice: the cores may overlap, are nearer than FL_GJK_DD_BELOW size,
 * or 64 supports did not end it.  In either case s is a valid start for the next stage. */
int fl_gjk_double(fl_core a, fl_core b, double size, fl_simplex *s, fl_vec3 *n, fl_support_heights *h,
                  int32_t *steps);

#endif
