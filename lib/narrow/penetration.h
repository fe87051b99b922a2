/* SPDX-License-Identifier: GPL-3.0-or-later */
/* penetration.h -- how far two convex cores that meet have to be moved apart, and which way. */
#ifndef FL_NARROW_PENETRATION_H
#define FL_NARROW_PENETRATION_H
#include <stdint.h>
#include "geom/poly.h"
#include "narrow/gjk.h"

/* A body as the narrow phase sees it, everything borrowed: the topology of its core, the vertices and
 * the outward face normals in world axes, and the dilation radius. */
typedef struct {
    const fl_poly *p;
    const fl_vec3 *v; /* [p->nv] world [m] */
    const fl_vec3 *n; /* [p->nf] world     */
    double r;         /* [m]               */
} fl_solid;

static inline fl_core fl_solid_core(const fl_solid *s) { return (fl_core){s->v, s->p->nv, s->p}; }

/* What became of the proposals of libccd; add up over calls.  NULL where nobody asks. */
typedef struct {
    int64_t queries;   /* overlaps looked at                                                         */
    int64_t no_answer; /* libccd found no overlap, or an answer that is not finite or not a direction */
    int64_t rejected;  /* its direction, measured by our own supports, is wider than the depth by
                     * more than 1e-6 of the extent                                              */
    int64_t capped;    /* it was stopped at the limit of support calls                               */
} fl_penetration_count;

typedef struct {
    double depth;       /* smallest shift that separates the cores, >= 0                         [m] */
    fl_vec3 n;          /* its unit direction, from b to a: move a by depth n                        */
    int32_t turns_with; /* n turns with a (1: its face), with b (-1), or is the product of two edges (0) */
    fl_vec3 ea, eb;     /* the unit vectors of those; n = +-(ea x eb)/|ea x eb|                          */
    fl_vec3 pa, pb;     /* a point of a deepest below, of b highest along n: pa - pb = -depth n; one of
                     * many where faces or edges are parallel                                [m] */
} fl_penetration;

/* Penetration depth of two cores that meet (fl_gap.overlap),
 *     depth = min over unit n of  max_b n.y - min_a n.x .
 * For polyhedra the minimum is attained at a face normal of a or b or at the cross product of an edge of
 * each; all are tried when ea eb <= 2^20, the edge pairs being thinned by the test that their arcs on the
 * Gauss sphere cross (Gregorius 2013).  Beyond that the faces are tried, and the direction that libccd's MPR
 * proposes (cores scaled to unit size about the centre of the pair, support calls capped) is carried to the
 * exact direction of the facet it belongs to.  libccd is asked in both cases and checked: see
 * fl_penetration_count. Points, segments and flat polygons are allowed.  Equal minima go to the direction
 * that points from the centre of b to that of a, then to the first in the order faces of a, faces of b,
 * edges: coincident bodies get one direction, always the same. Cannot fail.  Together with fl_gjk the signed
 * distance (d, or -depth) is continuous through zero. */
void fl_penetration_find(const fl_solid *a, const fl_solid *b, fl_penetration_count *count,
                         fl_penetration *out);

#endif
