/* SPDX-License-Identifier: GPL-3.0-or-later */
/* coplanar_regions.h -- the flat regions of a part: triangles that lie in one plane and hang together.
 *
 * Triangles are joined by the indices of their vertices, two at a side; of three or more at one the two that
 * go on flat over it.  A region grows from its largest triangle, and its plane is that of all that it took.
 */
#ifndef FL_STRUCTURE_COPLANAR_REGIONS_H
#define FL_STRUCTURE_COPLANAR_REGIONS_H
#include "geom/surface.h"

typedef struct {
    int32_t a, b; /* vertices, a < b */
    int32_t t;    /* triangle */
} fl_region_side;

typedef struct {
    const fl_part *p;
    double tol;             /* [m] */
    fl_vec3 *normal;        /* [nt] unit normals */
    fl_region_side *side;   /* [3 nt] sorted */
    int32_t *neighbour;     /* [3 nt] triangle over side k of triangle t at 3 t + k, -1 for none or several */
    int32_t *region;        /* [nt] flat region */
    fl_vec3 *region_normal; /* [regions] normals, of the largest triangle */
    double *region_offset;  /* [regions] plane offsets */
    double *area;           /* [regions] summed up by who needs it */
    int32_t *queue;
    int32_t regions;
    int closed;
    int32_t misoriented[2]; /* two triangles that share an edge and face different ways; -1 for none */
} fl_coplanar_regions;

/* Find them; f is zeroed, p borrowed.  -1 with FL_INPUT (the triangles have no area) or FL_SYSTEM. */
int fl_coplanar_regions_find(fl_coplanar_regions *f, const fl_part *p, fl_err *err);
void fl_coplanar_regions_free(fl_coplanar_regions *f);

/* Which side of t has the ends a and b; side k runs from corner k to corner k + 1. */
int fl_region_side_of(const fl_tri *t, int32_t a, int32_t b);

#endif
