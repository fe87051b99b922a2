/* SPDX-License-Identifier: GPL-3.0-or-later */
/* zone_mesh.h -- divides a convex block into tetrahedra, the zones of a deformable block.
 *
 * A block with the topology of a cube is divided as one: a trilinear grid of cells with sides of at most
 * `size`, five tetrahedra a cell, mirrored from cell to cell so that they match.  Any other block starts as
 * tetrahedra from its centroid to its faces.  Then the longest edge of all is halved, with every tetrahedron
 * around it, until no edge is longer than sqrt(2) size.  Longest-edge bisection keeps the quality of the
 * start within a constant factor; a block with sharp corners has flat zones there, which shorten the time
 * step. Source: Rivara, Int. J. Numer. Methods Eng. 20 (1984) 745-756.
 *
 * Zones are positively oriented, boundary triangles are counter-clockwise from outside. */
#ifndef FL_ZONE_ZONE_MESH_H
#define FL_ZONE_ZONE_MESH_H
#include "geom/poly.h"

typedef struct {
    int32_t nodes, zones, triangles;
    fl_vec3 *x;             /* [nodes] [m] */
    int32_t (*zone)[4];     /* [zones] nodes */
    int32_t (*triangle)[3]; /* [triangles] nodes of the boundary */
    int32_t *face;          /* [triangles] face of the block that each lies on */
} fl_zone_mesh;

/* Tetrahedra of a cell of a grid. */
enum fl_zone_split { FL_ZONE_SPLIT_FIVE, FL_ZONE_SPLIT_SIX };

/* The trilinear grid of n[0] n[1] n[2] cells over corner[ix + 2 iy + 4 iz], right-handed.  face is 0 for the
 * sides x = 0, 1, then y, then z.  -1 with FL_SYSTEM, or FL_INPUT for a zone without volume. */
int fl_zone_grid(fl_zone_mesh *m, const fl_vec3 corner[8], const int32_t n[3], enum fl_zone_split split,
                 fl_err *err);

/* The zones of the block p.  Errors as fl_zone_grid(). */
int fl_zone_mesh_make(fl_zone_mesh *m, const fl_poly *p, double size, fl_err *err);

/* Least distance of two parallel planes that touch p, one of them along a face [m]. */
double fl_zone_mesh_thickness(const fl_poly *p);

void fl_zone_mesh_free(fl_zone_mesh *m);

#endif
