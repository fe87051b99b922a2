/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mesh_patch.h -- quality measures of a triangulated part, and orientation of its patches. */
#ifndef FL_GEOM_MESH_PATCH_H
#define FL_GEOM_MESH_PATCH_H
#include "geom/surface.h"

/* For triangles with corners a, b, c about the centre o of the box, and for cones in closed form:
 *     V = sum a.(b x c) / 6,   A = sum |(b - a) x (c - a)| / 2,   C = o + sum (a + b + c) a.(b x c) / (24 V)
 * Taking o inside keeps precision far from the origin.  Cones and triangles are added as if they did not
 * overlap.  Edges are identified by vertex indices, so weld first; a triangle with a repeated index has none.
 * A patch is a set of triangles connected across edges of two triangles. */
typedef struct {
    int32_t vertices, triangles, cones;
    int32_t open;       /* edges of one triangle */
    int32_t branched;   /* edges of three or more triangles (non-manifold) */
    int32_t incoherent; /* edges of two triangles that both run along it in the same direction */
    int32_t patches;
    int32_t inverted;     /* closed coherent patches of negative volume */
    int32_t degenerate;   /* triangles with a repeated index, or no area in double precision */
    int closed;           /* every edge is used as often in one direction as in the other: V is defined */
    double volume;        /* V [m^3]; negative if inside out */
    double area;          /* A [m^2] */
    fl_vec3 centroid;     /* C [m] if closed and V is not 0; else the centroid of the area */
    double shortest_edge; /* length of the shortest edge [m]; INFINITY without triangles */
    fl_aabb box;          /* of used vertices and of cones */
} fl_mesh_quality;

/* Measure one part, or all parts of a surface together: counts, volumes and areas add up, and the centroid is
 * the common one.  Return 0, or -1 with FL_SYSTEM. */
int fl_part_measure(const fl_part *p, fl_mesh_quality *q, fl_err *err);
int fl_surface_measure(const fl_surface *s, fl_mesh_quality *q, fl_err *err);

typedef struct {
    int32_t triangles; /* turned one by one, to agree with the larger area of their patch */
    int32_t patches;   /* turned as a whole: negative volume, or a skin facing inward */
    int32_t kept_side; /* open patches, outside on both sides: oriented by most of their area */
    int32_t one_sided; /* one-sided patches (Moebius), which cannot be coherent */
} fl_orient_counts;

/* Makes each patch coherent by flood fill across edges of two triangles.  Then closed patches are turned to
 * positive volume, and patches that end in branched edges are turned outward (outer_skin.h) if only one of
 * their sides is outside.  Inner walls keep the side that most of their area had.  Cones need no orientation.
 *   came   the measures of the part as it came, as by fl_part_measure().  If nothing is turned (o->triangles
 *          and o->patches are 0), they still hold
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_part_orient(fl_part *p, fl_mesh_quality *came, fl_orient_counts *o, fl_err *err);

#endif
