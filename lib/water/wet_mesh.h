/* SPDX-License-Identifier: GPL-3.0-or-later */
/* wet_mesh.h -- linear pressure on the wet part of a closed mesh of triangles, exact, at a price that grows
 * as the number of triangles at the water line.
 *
 * With the head p = c - G.x, positive in the water, all of the mesh's load is in the integrals over its wet
 * part
 *     A = int n dA,   M_ij = int x_i n_j dA,   Q_ij = int x_i (x x n)_j dA,   a = int dA:
 *     F = -int p n dA = -(c A - G.M),   T = -int p x x n dA = -(c S - G.Q),   S_i = e_ijk M_jk,
 * and in their change with the pose. p is 0 on the water line, so the wet part may be taken as fixed. The
 * triangles stand in a tree of boxes. A box that is wholly wet adds its sums, one wholly dry nothing; only
 * the leaves at the water line are cut triangle by triangle. All is in axes of the mesh. */
#ifndef FL_WATER_WET_MESH_H
#define FL_WATER_WET_MESH_H
#include <stdint.h>
#include "base/err.h"
#include "geom/mat3.h"

typedef struct {
    fl_vec3 A;     /* [m2] */
    fl_mat3 M, Q;  /* [m3], [m4] */
    double wetted; /* [m2] */
} fl_wet_sums;

/* A box and its triangles; its children, if any, are the next box and `second`. */
typedef struct {
    fl_vec3 middle, half; /* [m] */
    fl_wet_sums sums;     /* of all its triangles */
    int32_t first, last;  /* triangles */
    int32_t second;       /* 0: a leaf */
} fl_wet_box;

typedef struct {
    int32_t n, boxes; /* triangles, boxes */
    fl_vec3 *v;       /* [3 n] corners, counter-clockwise from outside, in the order of the tree [m] */
    fl_wet_box *box;  /* [boxes] the first holds all */
    double reach;     /* of the corners from the origin [m] */
} fl_wet_mesh;

/* Takes over v[3 n], n > 0; frees it on failure. Returns -1 with FL_SYSTEM. */
int fl_wet_mesh_make(fl_wet_mesh *m, fl_vec3 *v, int32_t n, fl_err *err);
void fl_wet_mesh_free(fl_wet_mesh *m); /* accepts a zeroed struct, leaves one */

/* Sums over the part with c - G.x > 0. */
void fl_wet_mesh_sums(const fl_wet_mesh *m, fl_vec3 G, double c, fl_wet_sums *out);

/* Force and moment of the head c - G.x over its wet part, over rho g [m3], [m4]. */
void fl_wet_sums_load(const fl_wet_sums *s, fl_vec3 G, double c, fl_vec3 *force, fl_vec3 *moment);

#endif
