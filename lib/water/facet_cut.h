/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet_cut.h -- the wetted (or the dry) surface of a solid as pieces with an area and a centre, for sums
 * over it.
 *
 * Each facet has its own plane, r = c n + x e + y g, with n = e x g outward. The part of it on one side of
 * the water is a fan of triangles about its centroid, with a piece at the middle of each triangle side. The
 * sum is exact for integrands quadratic in position. Four facets are processed side by side; the facet with
 * the most corners uses the lanes that the others leave.
 *
 * For a right prism whose long edges lie along a body axis and all cross the water plane, each side is a
 * trapezoid, with g along that axis: over [x0, x1] from the cap at y0 on,
 *     l(x) = (level - c up.n - x up.e) / up.g - y0,   a = l(x0),   b = l(x1),   L = x1 - x0,
 * with its centroid at x0 + L (a + 2b) / (3 (a + b)), y0 + (a^2 + ab + b^2) / (3 (a + b)). A cap, and a body
 * wholly wet, is whole. Whole facets are not cut again while they stay whole. */
#ifndef FL_WATER_FACET_CUT_H
#define FL_WATER_FACET_CUT_H
#include "base/simd.h"
#include "water/buoyancy.h"

/* Four facets, or parts of one; unused lanes are zero. */
typedef struct {
    double n[3][FL_SIMD_WIDTH], e[3][FL_SIMD_WIDTH], g[3][FL_SIMD_WIDTH], c[FL_SIMD_WIDTH];
    double x0[FL_SIMD_WIDTH], x1[FL_SIMD_WIDTH]; /* of sides of a prism [m] */
    int32_t pieces;                              /* pieces per lane */
} fl_facet_group;

/* One piece of each of the four; lanes with fewer pieces end in pieces of no area. */
typedef struct {
    double area[FL_SIMD_WIDTH], x[FL_SIMD_WIDTH], y[FL_SIMD_WIDTH]; /* [m2], [m] */
} fl_facet_piece;

/* Velocity of the fluid at a piece along e, g and n, in the frame in which v of the body is given [m/s]. */
typedef struct {
    double u[3][FL_SIMD_WIDTH];
} fl_facet_flow;

/* Which part of the surface is stored. */
enum fl_facet_cut_state {
    FL_FACET_CUT_UNSET,
    FL_FACET_CUT_NONE,
    FL_FACET_CUT_WHOLE,
    FL_FACET_CUT_TOP,
    FL_FACET_CUT_BOTTOM,
    FL_FACET_CUT_GENERAL
};

typedef struct {
    fl_facet_group *group; /* [groups] of [max_groups] */
    fl_facet_piece *piece; /* pieces of one group after another; [max_pieces] allocated */
    fl_facet_flow *flow;   /* likewise; NULL if the flow is the same at all pieces */
    int32_t groups, max_groups, max_pieces;
    int dry; /* 1: above the water plane, 0: below it */
    /* TOP, BOTTOM: all sides of a prism, then that cap in a group of its own */
    enum fl_facet_cut_state state;
    int32_t cap_axis; /* then fl_facets.cap_axis, else -1 */
} fl_facet_cut;

/* The planes of the faces of a hull. */
typedef struct {
    fl_vec3 *axis;        /* [2 nf] e and g of each face */
    int32_t most_corners; /* face with the most corners */
    int32_t top, bottom;  /* caps of a right prism along a body axis, or -1 */
    int32_t cap_axis;     /* that axis, 0 to 2, or -1 */
    double y0, y1;        /* positions of the caps along it [m] */
    double max_radius;    /* max |x_v| [m] */
} fl_facets;

/* Makes the planes of a hull that has face areas. Returns -1 with FL_SYSTEM. */
int fl_facets_make(fl_facets *k, const fl_hull *h, fl_err *err);
void fl_facets_free(fl_facets *k); /* accepts a zeroed struct, leaves one */

/* Allocates an unset cut. flows: whether pieces have their own flow. Returns -1 with FL_SYSTEM; the cut is
 * freed by the caller then. */
int fl_facet_cut_make(fl_facet_cut *s, const fl_hull *h, int dry, int flows, fl_err *err);
void fl_facet_cut_free(fl_facet_cut *s); /* accepts a zeroed struct, leaves one */

/* Cuts the surface: below the plane up.x = level, or above it if dry is set. Does not touch flow. */
void fl_facet_cut_update(fl_facet_cut *s, const fl_facets *k, const fl_hull *h, fl_vec3 up, double level);

/* Bytes allocated. */
double fl_facets_bytes(const fl_facets *k, const fl_hull *h);
double fl_facet_cut_bytes(const fl_facet_cut *s);

/* Components of a along the axes e, g and n of the facet in lane l, and back. */
static inline fl_vec3 fl_facet_group_to_local(const fl_facet_group *f, int l, fl_vec3 a)
{
    return v3(v3_dot(v3(f->e[0][l], f->e[1][l], f->e[2][l]), a),
              v3_dot(v3(f->g[0][l], f->g[1][l], f->g[2][l]), a),
              v3_dot(v3(f->n[0][l], f->n[1][l], f->n[2][l]), a));
}

static inline fl_vec3 fl_facet_group_to_body(const fl_facet_group *f, int l, fl_vec3 a)
{
    const fl_vec3 e = v3(f->e[0][l], f->e[1][l], f->e[2][l]), g = v3(f->g[0][l], f->g[1][l], f->g[2][l]),
                  n = v3(f->n[0][l], f->n[1][l], f->n[2][l]);
    return v3_madd(v3_madd(v3_scale(a.x, e), a.y, g), a.z, n);
}

/* Position of the piece in lane l, body axes [m]. */
static inline fl_vec3 fl_facet_piece_position(const fl_facet_group *f, const fl_facet_piece *row, int l)
{
    return fl_facet_group_to_body(f, l, v3(row->x[l], row->y[l], f->c[l]));
}

#endif
