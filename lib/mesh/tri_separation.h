/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tri_separation.h -- is there a plane between two triangles? */
#ifndef FL_MESH_TRI_SEPARATION_H
#define FL_MESH_TRI_SEPARATION_H
#include "geom/surface.h"

/* A triangle of a part, as the question wants it. */
typedef struct {
    int32_t t;
    int has_normal;   /* n and size, when they are asked for */
    const int32_t *v; /* its vertices, in the part */
    fl_vec3 x[3];
    fl_vec3 n, n_abs; /* (x1 - x0) x (x2 - x0), and the same of sizes, which bounds its rounding */
} fl_tri_data;

void fl_tri_load(const fl_part *p, int32_t t, fl_tri_data *c);

/* Are the two apart, but for the corners and edges they have in common, for certain?  Tried are the planes of
 * the two and those that stand upright on their edges, planes through a common corner, and at a common edge
 * whether they bend by less than a right angle; what rounding may decide is not certain.  Returns 1, or 0
 * for anything else.  Source: Shewchuk, Discrete & Comput. Geom. 18 (1997) 305, the bounds. */
int fl_tri_separated(fl_tri_data *a, fl_tri_data *b);

/* Is there a plane between the triangles a[na] and b[nb] of p, so that no two have a point in common, for
 * certain?  Tried are those across the sum of the normals of either: of sectors of a cone or of a cylinder,
 * whose boxes are all in one another, these lie between any two that are no neighbours.  Returns 1, or 0 for
 * anything else. */
int fl_tri_groups_separated(const fl_part *p, const int32_t *a, int na, const int32_t *b, int nb);

#endif
