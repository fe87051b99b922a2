/* SPDX-License-Identifier: GPL-3.0-or-later */
/* simplex.h -- types of the distance query (gjk.h): convex cores, simplices, warm start, result. */
#ifndef FL_NARROW_SIMPLEX_H
#define FL_NARROW_SIMPLEX_H
#include <stdint.h>
#include "geom/poly.h"

/* The convex hull of n >= 1 points in world coordinates [m], borrowed.  The points may coincide, and may lie
 * on a line or in a plane; faces are not needed.  p: the body whose vertices they are, wherever it has moved,
 * or NULL.  p->size saves a pass over the points.  For more than FL_CORE_SMALL points the edges of p lead to
 * the support point, so a warm query costs only the vertices near the closest points. */
typedef struct {
    const fl_vec3 *v;
    int32_t n;
    const fl_poly *p;
} fl_core;

/* Warm start: the vertex pairs (a[k], b[k]) of the simplex that ended the last query of this pair.  Zeroed:
 * cold.  Any content is safe: an index out of range makes the start cold. */
typedef struct {
    int32_t n, a[4], b[4];
} fl_gjk_cache;

typedef struct {
    double d;           /* distance >= 0; 0 when the cores overlap                              [m] */
    fl_vec3 pa, pb;     /* closest points of a and of b: pa - pb = d n, to the rounding of world
                         * coordinates; a common point when the cores overlap                   [m] */
    fl_vec3 n;          /* unit vector from b to a; zero when the cores overlap                     */
    int32_t overlap;    /* 1 when the cores touch (d = 0) or penetrate                              */
    int32_t iterations; /* support evaluations of all stages                                        */
    int32_t na, nb;     /* closest features: the vertices of a and of b whose hulls contain pa and pb
                         * in their relative interior, ascending; (na, nb) is one of (1,1) (1,2)
                         * (2,1) (2,2) (1,3) (3,1), or (0,0) when the cores overlap                 */
    int32_t ia[3], ib[3];
} fl_gap;

/* Up to four vertex differences w[k] = a.v[a[k]] - b.v[b[k]], each pair once. */
typedef struct {
    int32_t n, a[4], b[4];
    fl_vec3 w[4];
} fl_simplex;

#endif
