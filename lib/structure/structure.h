/* SPDX-License-Identifier: GPL-3.0-or-later */
/* structure.h -- what ice meets, as pieces that a contact can be computed with.
 *
 * Triangles of a part that lie in one plane and hang together become one face first, so that a flat wall
 * loads the ice the same whether it is 2 triangles or 20 000.  Then a part is
 *   a solid   when it is closed and convex: one convex polyhedron, the half-spaces of its faces;
 *   a plate   when it is one flat convex polygon, which is felt from both sides;
 *   a shell   otherwise: those faces in convex tiles, and of edges and vertices those where the surface
 * bends, straight runs whole. A truncated cone is a piece of its own.  It is exact for spheres, and under the
 * law `patch` for polyhedra whose centre is farther from both its ends than twice their bounding radius
 * (patch/cone.h); nearer to an end it becomes, by a smooth share of the energy, a frustum of
 * FL_CONE_SIDES sides and the same cross-section, which it is for the other laws. */
#ifndef FL_STRUCTURE_STRUCTURE_H
#define FL_STRUCTURE_STRUCTURE_H
#include "structure/persistence_contact.h"
#include "broad/bvh.h"
#include "geom/poly.h"
#include "geom/quat.h"
#include "geom/surface.h"

enum { FL_CONE_SIDES = 96 };

typedef enum { FL_PIECE_SOLID, FL_PIECE_CONE, FL_PIECE_PLANE, FL_PIECE_MESH } fl_piece_kind;

/* The faces of a shell are convex tiles of its flat regions (geom/merge_coplanar.h), of one triangle each where it is
 * curved; core.edge and corner[] only what bends or ends there. */
typedef struct {
    int32_t corners;
    int32_t *corner;       /* [corners] vertices of core where the surface bends */
    fl_aabb *box;          /* [core.nf] of the faces */
    fl_bvh tree;           /* over box */
    fl_bvh edge_tree;      /* over edge_box */
    fl_aabb *edge_box;     /* [core.ne] */
    int32_t *concave_face; /* core.lean */
    uint8_t *saddle;       /* core.fork */
    fl_tile_seams seams;   /* only where fl_structure_prepare_spheres() was asked for them */
} fl_piece_mesh;

typedef struct {
    fl_piece_kind kind;
    int32_t part;           /* index in the surface */
    fl_vec3 x;              /* origin of the frame of the piece [m] */
    fl_quat q;              /* its axes */
    fl_poly core;           /* in that frame; a plate for plates */
    int elastic;            /* a plane on springs */
    int one_sided;          /* a flat sheet that is a shell: what comes from behind feels nothing of it */
    int32_tinward_triangle; /* a closed shell, a body of which looks inward: 1 + its first triangle; all is solid but
                       * what that encloses */
    double r0, r1, h; /* cone: between z = 0 and z = h of the frame */
    fl_piece_mesh mesh;
    double largest_region_area; /* area of the largest flat region of a shell, however it is cut up [m2] */
} fl_piece;

typedef struct {
    int32_t n, cap;
    fl_piece *piece;
} fl_structure;

/* Build the pieces of all parts.  Welds nothing: triangles are joined by the indices of their vertices.
 * -1 with FL_INPUT (a part whose triangles have no area, or of which two that share an edge with no third
 * face different ways) or FL_SYSTEM. */
int fl_structure_build(fl_structure *s, const fl_surface *surface, fl_err *err);

/* Make ready for balls, which ask where the walls of shells meet.  -1 with FL_SYSTEM. */
int fl_structure_prepare_spheres(fl_structure *s, fl_err *err);
void fl_structure_free(fl_structure *s);

#endif
