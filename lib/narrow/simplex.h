/* SPDX-License-Identifier: GPL-3.0-or-later */
/* simplex.h -- types of the distance of two convex cores (gjk.h): cores, simplices, the result. */
#ifndef FL_NARROW_SIMPLEX_H
#define FL_NARROW_SIMPLEX_H
#include <stdint.h>
#include "geom/poly.h"

/* The convex hull of n >= 1 points in world coordinates [m], borrowed.  The points may coincide, and may
 * lie on a line or in a plane; faces are not needed.  p is the body whose vertices they are, wherever it
 * has been moved to, or NULL: its size saves a look at all of them, and of more than 64 its edges lead to
 * those that matter, so that a warm query costs what the vertices about the nearest points cost. */
typedef struct {
    const fl_vec3 *v;
    int32_t n;
    const fl_poly *p;
} fl_core;

/* Warm start: the pairs of vertices (a[k], b[k]) that the last query of this pair ended on.  Zeroed means
 * cold.  Any content is safe: an index out of range makes the start cold. */
typedef struct {
    int32_t n, a[4], b[4];
} fl_gjk_cache;

typedef struct {
    double d;           /* distance >= 0; 0 when the cores meet                                 [m] */
    fl_vec3 pa, pb;     /* nearest points of a and of b: pa - pb = d n, to the rounding of world
                         * coordinates; where the cores meet, a point of both                    [m] */
    fl_vec3 n;          /* unit vector from b to a; zero when the cores meet                         */
    int32_t overlap;    /* 1 when the cores meet: touch (d = 0) or penetrate                         */
    int32_t iterations; /* supports evaluated, all stages together                                   */
    int32_t na, nb;     /* the nearest features: the vertices of a and of b whose hulls hold pa and
                         * pb in their relative interior, ascending; (na, nb) is one of (1,1) (1,2)
                         * (2,1) (2,2) (1,3) (3,1), or (0,0) when the cores meet                     */
    int32_t ia[3], ib[3];
} fl_gap;

/* Up to four vertex differences w[k] = a.v[a[k]] - b.v[b[k]], each pair once. */
typedef struct {
    int32_t n, a[4], b[4];
    fl_vec3 w[4];
} fl_simplex;

#endif
