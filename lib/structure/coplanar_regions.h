/* SPDX-License-Identifier: GPL-3.0-or-later */
/* coplanar_regions.h -- flat regions of a part: connected triangles of one plane.
 *
 * Triangles are joined by the indices of their vertices, two at a side. Of three or more at one side, the two
 * that continue most nearly in one plane are joined. A region grows from its largest triangle; its plane is
 * fitted to all of its triangles. */
#ifndef FL_STRUCTURE_COPLANAR_REGIONS_H
#define FL_STRUCTURE_COPLANAR_REGIONS_H
#include "geom/surface.h"

typedef struct {
    int32_t a, b; /* vertices, a < b */
    int32_t t;    /* triangle */
} fl_region_side;

typedef struct {
    const fl_part *p;
    double tol;           /* [m] */
    fl_vec3 *normal;      /* [nt] unit normals */
    fl_region_side *side; /* [3 nt] sorted */
    /* [3 nt] triangle across side k of triangle t at 3 t + k, -1 for none or several */
    int32_t *neighbour;
    int32_t *region;        /* [nt] region of each triangle */
    fl_vec3 *region_normal; /* [regions] unit normals of the fitted planes */
    double *region_offset;  /* [regions] plane offsets */
    double *area;           /* [regions] zero; the caller may sum areas here */
    int32_t *queue;
    int32_t regions;
    int closed;
    int32_t misoriented[2]; /* two triangles with a common edge and opposite orientation; -1 for none */
} fl_coplanar_regions;

/* Finds the regions; f is zeroed, p borrowed. Returns -1 with FL_INPUT (the triangles have no area) or
 * FL_SYSTEM. */
int fl_coplanar_regions_find(fl_coplanar_regions *f, const fl_part *p, fl_err *err);
void fl_coplanar_regions_free(fl_coplanar_regions *f);

/* The side of t with the ends a and b; side k runs from corner k to corner k + 1. */
int fl_region_side_of(const fl_tri *t, int32_t a, int32_t b);

#endif
