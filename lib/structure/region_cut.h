/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region_cut.h -- the surface of several pieces that touch or intersect, as convex polygons.
 *
 * A body is a piece: a solid with an inside, a plate with two sides, or an open surface with one.  A face
 * of a body is cut along the faces of the others that it meets.  Of the fragments these go:
 *   - what lies in a solid;
 *   - what lies on a face of another body that faces the opposite way: there two solids stand together;
 *   - of two fragments in one place that face the same way, one: a solid's face stays before that of a plate,
 *     a plate before an open surface, else that of the body that comes first.
 * The rest is the surface of the union.  Corners of one polygon may lie on sides of others
 * (region_join.h).
 *
 * Limits.  A fragment counts as a whole, by its middle, so bodies must meet within `tol`.  Cuts go
 * through a whole polygon.  An open surface hides nothing: what is behind it stays. */
#ifndef FL_STRUCTURE_REGION_CUT_H
#define FL_STRUCTURE_REGION_CUT_H
#include "structure/structure.h"

/* A convex polygon, counter-clockwise about its normal. */
typedef struct {
    int32_t first, n; /* vertices */
    fl_vec3 normal;
    int32_t body;
    int two_sided;
    int on_cone; /* of the side of a cone */
} fl_region_polygon;

typedef struct {
    int32_t n, cap, nv, v_cap;
    fl_region_polygon *polygon; /* [n] */
    fl_vec3 *v;                 /* [nv] from `origin` [m] */
    fl_vec3 origin;             /* [m] */
    double tol;                 /* [m] */
    int open;                   /* some body is an open surface */
} fl_region_surface;

/* True if the pieces a and b are nearer than tol [m], or one lies in the other.  -1 with FL_SYSTEM. */
int fl_pieces_touch(const fl_piece *a, const fl_piece *b, double tol, fl_err *err);

/* True if x, in the pose of the file, lies in a piece with an inside. */
int fl_piece_contains(const fl_piece *p, fl_vec3 x);

/* Makes the surface of the union of n pieces.  Returns -1 with FL_SYSTEM. */
int fl_region_cut(fl_region_surface *s, int32_t n, const fl_piece *const *piece, double tol, fl_err *err);
void fl_region_surface_free(fl_region_surface *s);

#endif
