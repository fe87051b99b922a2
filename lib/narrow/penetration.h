/* SPDX-License-Identifier: GPL-3.0-or-later */
/* penetration.h -- penetration depth and direction of two convex cores that overlap. */
#ifndef FL_NARROW_PENETRATION_H
#define FL_NARROW_PENETRATION_H
#include <stdint.h>
#include "geom/poly.h"
#include "narrow/gjk.h"

/* A body for the narrow phase, all borrowed: topology of the core, vertices and outward face normals in world
 * axes, dilation radius. */
typedef struct {
    const fl_poly *p;
    const fl_vec3 *v; /* [p->nv] world [m] */
    const fl_vec3 *n; /* [p->nf] world     */
    double r;         /* [m]               */
} fl_solid;

static inline fl_core fl_solid_core(const fl_solid *s) { return (fl_core){s->v, s->p->nv, s->p}; }

/* Statistics of libccd's proposals, added up over calls. */
typedef struct {
    int64_t queries;   /* overlaps                                                                     */
    int64_t no_answer; /* libccd found no overlap, or its direction was not finite or no unit vector   */
    int64_t rejected;  /* its direction is wider than the depth by more than 1e-6 of the extent,
                        * measured by our own supports                                                 */
    int64_t capped;    /* it was stopped at the limit of support calls                                 */
} fl_penetration_count;

typedef struct {
    double depth;       /* smallest translation that separates the cores, >= 0              [m] */
    fl_vec3 n;          /* its unit direction, from b to a: move a by depth n                   */
    int32_t turns_with; /* n is a face normal of a (1), of b (-1), or across two edges (0)      */
    fl_vec3 ea, eb;     /* unit vectors of those edges; n = +-(ea x eb)/|ea x eb|               */
    fl_vec3 pa, pb;     /* a deepest point of a and one of b along n: pa - pb = -depth n; one pair
                         * of many where faces or edges are parallel                        [m] */
} fl_penetration;

/* Penetration depth of two cores that overlap (fl_gap.overlap),
 *     depth = min over unit n of  max_b n.y - min_a n.x .
 * For polyhedra the minimum is at a face normal of a or b or at the cross product of an edge of each.  All
 * are tried when the product of the edge counts is at most 2^20; edge pairs whose arcs on the Gauss sphere do
 * not cross are left out (Gregorius 2013).  Beyond that the faces are tried, and the direction that libccd's
 * MPR proposes (cores scaled to unit size about the centre of the pair, support calls limited) is refined to
 * the exact direction of its facet.  libccd is called in both cases and checked: see fl_penetration_count.
 *
 * Points, segments and flat polygons are allowed.  Of equal minima the direction from the centre of b to that
 * of a is taken, then the first in the order faces of a, faces of b, edges; so coincident bodies always get
 * the same direction.  Cannot fail.  With fl_gjk() the signed distance (d, or -depth) is continuous through
 * zero.
 *     count   may be NULL */
void fl_penetration_find(const fl_solid *a, const fl_solid *b, fl_penetration_count *count,
                         fl_penetration *out);

#endif
