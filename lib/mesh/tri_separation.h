/* SPDX-License-Identifier: GPL-3.0-or-later */
/* tri_separation.h -- tests for a separating plane between triangles, certified against rounding errors. */
#ifndef FL_MESH_TRI_SEPARATION_H
#define FL_MESH_TRI_SEPARATION_H
#include "geom/surface.h"

/* A triangle of a part. */
typedef struct {
    int32_t t;
    int has_normal;   /* n and n_abs have been computed */
    const int32_t *v; /* indices of its vertices in the part */
    fl_vec3 x[3];
    fl_vec3 n;     /* (x1 - x0) x (x2 - x0) */
    fl_vec3 n_abs; /* the same with absolute values: bounds the rounding error of n */
} fl_tri_data;

void fl_tri_load(const fl_part *p, int32_t t, fl_tri_data *c);

/* True if the two triangles are certainly disjoint but for the corners and edges they share.  Candidate
 * planes:
 *
 *      no common corner    the planes of the two triangles, and planes through their edges normal to them
 *      one common corner   planes through that corner, and the planes of the two triangles
 *      a common edge       separated where the triangles bend at it by less than 90 degrees
 *
 * Returns 1, or 0 where rounding may decide.  Source: Shewchuk, Discrete & Comput. Geom. 18 (1997) 305, the
 * error bounds. */
int fl_tri_separated(fl_tri_data *a, fl_tri_data *b);

/* True if a plane certainly separates the triangles a[0 .. na) from b[0 .. nb) of p, so that no two have a
 * common point.  Candidates are the planes normal to the sum of the normals of either group.  They separate
 * the sectors of a cone or cylinder, whose boxes all overlap, unless the groups are neighbours.  Returns 1,
 * or 0 where rounding may decide. */
int fl_tri_groups_separated(const fl_part *p, const int32_t *a, int na, const int32_t *b, int nb);

#endif
