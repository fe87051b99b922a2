/* SPDX-License-Identifier: GPL-3.0-or-later */
/* structure.h -- the structure as pieces that contacts can be computed with.
 *
 * Connected triangles of a part in one plane become one face first, so that a flat wall loads the ice alike
 * with 2 triangles or 20 000. Then a part is
 *   a solid   if closed and convex: one convex polyhedron, the half-spaces of its faces;
 *   a plate   if one flat convex polygon, which is two-sided;
 *   a mesh    otherwise: its faces in convex tiles, and the edges and vertices where the surface bends,
 *             straight runs as one edge.
 * Pieces that touch are joined to one afterwards (region.h).
 * A truncated cone is a piece of its own. It is exact for spheres, and under the law `patch` for polyhedra
 * whose centre is farther from both ends of the cone than twice their bounding radius (patch/cone.h). Nearer
 * to an end it turns, by a smooth share of the energy, into a frustum of FL_CONE_SIDES sides and the same
 * cross-section, which it is for the other laws. */
#ifndef FL_STRUCTURE_STRUCTURE_H
#define FL_STRUCTURE_STRUCTURE_H
#include "structure/persistence_contact.h"
#include "broad/bvh.h"
#include "geom/poly.h"
#include "geom/quat.h"
#include "geom/surface.h"

enum { FL_CONE_SIDES = 96 };

typedef enum { FL_PIECE_SOLID, FL_PIECE_CONE, FL_PIECE_PLANE, FL_PIECE_MESH } fl_piece_kind;

/* A mesh. Its faces are convex tiles of flat regions (geom/merge_coplanar.h), single triangles where it is
 * curved. core.edge and corner[] hold only what bends or ends. */
typedef struct {
    int32_t corners;
    int32_t *corner;       /* [corners] vertices of core where the surface bends */
    fl_aabb *box;          /* [core.nf] of the faces */
    fl_bvh tree;           /* over box */
    fl_bvh edge_tree;      /* over edge_box */
    fl_aabb *edge_box;     /* [core.ne] */
    int32_t *concave_face; /* core.concave_face */
    uint8_t *saddle;       /* core.saddle */
    fl_tile_seams seams;   /* only after fl_structure_prepare_spheres() */
    int closed;            /* no rim: every edge has a face on both sides */
    double outer_winding;  /* winding number of what is in front: 0, or -1 if all outside is solid */
    uint8_t *thin;         /* [core.nf] 1: a side of a sheet that has two; NULL: no such face */
    int32_t *cone_of_face; /* [core.nf] facet of the side of that free cone, -1: of none; NULL: no cones */
} fl_piece_mesh;

/* A cone in a joined piece, and the heights at which nothing else is near its side (region_cone.h). */
typedef struct {
    double from, to;
} fl_interval;

typedef struct {
    fl_vec3 x; /* its frame, in that of the piece [m] */
    fl_quat q;
    double r0, r1, h; /* [m] */
    int32_t n;
    fl_interval *free; /* [n] of z, ascending [m] */
} fl_free_cone;

/* What a joined piece (region.h) was made of: the triangles of a part (cone -1), or a cone of it. */
typedef struct {
    int32_t part, cone;
} fl_piece_member;

typedef struct {
    fl_piece_kind kind;
    int32_t part;  /* index in the surface; of a joined piece that of its first member */
    int32_t cone;  /* index among the cones of the part, -1 for others */
    fl_vec3 x;     /* origin of the frame of the piece [m] */
    fl_quat q;     /* axes of that frame */
    fl_poly core;  /* in that frame; of a plate with two faces */
    int elastic;   /* 1: a wall on springs */
    int one_sided; /* 1: a flat sheet that is a mesh; nothing acts on what comes from behind */
    /* of a closed mesh with a body that encloses less than nothing: 1 + its first triangle; else 0 */
    int32_t inward_triangle;
    double r0, r1, h; /* cone: between z = 0 and z = h of the frame */
    fl_piece_mesh mesh;
    double largest_region_area; /* of the largest flat region of a mesh, however it is divided [m2] */
    int32_t members;            /* of a joined piece; else 0 */
    fl_piece_member *member;    /* [members] */
    int32_t cones;              /* of a joined piece that is a mesh */
    fl_free_cone *free_cone;    /* [cones] */
    double facet_error;         /* distance of facets and free cones, at most [m] */
    int several_parts;          /* the members are of several parts */
} fl_piece;

typedef struct {
    int32_t n, cap;
    fl_piece *piece;
    int32_t unjoined,
        unjoined_part; /* groups of pieces that touch and yet could not be joined; the first part
                                      * of the last of them */
} fl_structure;

/* Builds the pieces of all parts. Welds nothing: triangles are joined by the indices of their vertices.
 * Returns -1 with FL_INPUT (a part whose triangles have no area, or two of which share an edge with no third
 * one and face different ways) or FL_SYSTEM. */
int fl_structure_build(fl_structure *s, const fl_surface *surface, fl_err *err);

/* Adds the piece of the joined surface of several pieces (region.h).
 *   of     [p->nt] what the triangles are of
 *   part   index in the surface
 * Returns -1 as above, and s untouched. */
typedef struct {
    int32_t cone; /* a facet of the side of that cone, -1: of none */
    int thin;     /* 1: a side of a sheet that has two */
} fl_joined_triangle;
int fl_structure_add_joined(fl_structure *s, const fl_part *p, const fl_joined_triangle *of, int32_t part,
                            fl_err *err);

/* Makes the piece of a cone; piece is zeroed.  -1 with FL_SYSTEM. */
int fl_cone_piece(fl_piece *piece, const fl_cone *c, fl_err *err);

/* Prepares the meshes for contact with spheres, which needs the seams of tiles. Returns -1 with FL_SYSTEM. */
int fl_structure_prepare_spheres(fl_structure *s, fl_err *err);
/* Box of a piece, and of one of its faces, in the pose of the file. */
fl_aabb fl_piece_box(const fl_piece *p);
fl_aabb fl_piece_face_box(const fl_piece *p, int32_t f);

void fl_piece_free(fl_piece *p);
void fl_structure_free(fl_structure *s);

#endif
