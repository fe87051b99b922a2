/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_patch.h -- how good a triangulated part is, and turning its patches outward. */
#ifndef FL_GEOM_MESH_PATCH_H
#define FL_GEOM_MESH_PATCH_H
#include "geom/surface.h"

/* Of triangles with corners a, b, c about the centre o of the box, and of cones by their closed forms:
 *     V = sum a.(b x c) / 6,   A = sum |(b - a) x (c - a)| / 2,   C = o + sum (a + b + c) a.(b x c) / (24 V)
 * Taking o inside keeps the digits of a part that stands far from the origin.  Cones and triangles are added
 * up as if they did not overlap.  Edges are told apart by the indices of their ends, so weld first; a
 * triangle that repeats an index has none.  A patch is a set of triangles joined across edges of two
 * triangles. */
typedef struct {
    int32_t vertices, triangles, cones;
    int32_t open;       /* edges of one triangle                                                   */
    int32_t branched;   /* edges of three or more triangles (non-manifold)                         */
    int32_t incoherent; /* edges of two triangles that both run along it the same way              */
    int32_t patches;
    int32_t inverted;     /* patches closed and coherent, and of negative volume                     */
    int32_t degenerate;   /* triangles with a repeated index, or no area to double precision         */
    int closed;           /* every edge is run along as often one way as the other: V has a meaning  */
    double volume;        /* V [m^3]; negative when inside out                                       */
    double area;          /* A [m^2]                                                                 */
    fl_vec3 centroid;     /* C [m] when closed and V is not 0; else that of the area                 */
    double shortest_edge; /* shortest edge [m]; INFINITY without triangles                           */
    fl_aabb box;          /* of vertices in use and of cones                                         */
} fl_mesh_quality;

/* Measure one part, or all of a surface as one: counts, volumes and areas add up, and the centroid is the
 * common one.  Return 0, or -1 with FL_SYSTEM. */
int fl_part_measure(const fl_part *p, fl_mesh_quality *q, fl_err *err);
int fl_surface_measure(const fl_surface *s, fl_mesh_quality *q, fl_err *err);

typedef struct {
    int32_t triangles; /* turned singly, to agree with the larger part of the area of their patch */
    int32_t patches;   /* turned as a whole: of negative volume, or a skin that looked inward    */
    int32_t kept_side; /* patches with a rim and the outside on both sides: they keep the side that
                               most of their area had */
    int32_t one_sided; /* patches with one side only (Moebius): they cannot be made coherent     */
} fl_orient_counts;

/* Make each patch coherent by flood fill across edges of two triangles, then turn closed patches to positive
 * volume, and those that end in branched edges outward (outer_skin.h), where one side of them alone is outside;
 * walls inside keep the side that most of their area had.  Cones need none of this.
 *   came   what fl_part_measure() says of the part as it came.  Where nothing is turned (o->triangles and
 *          o->patches are 0), of what it is now, too
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_part_orient(fl_part *p, fl_mesh_quality *came, fl_orient_counts *o, fl_err *err);

#endif
