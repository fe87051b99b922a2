/* SPDX-License-Identifier: GPL-3.0-or-later */
/* facet_cut.h -- the wetted (or the dry) surface of a solid in pieces, facet by facet, for sums over it.
 *
 * Each facet has a plane of its own, r = c n + x e + y g, with n = e x g outward. What the water leaves of
 * it is a fan of triangles about its centroid, with a piece at the middle of each of their sides: exact for
 * what is quadratic in place. Four facets lie side by side, and the one with the most corners takes all
 * lanes that the others leave.
 *
 * Of a right prism whose long edges lie along an axis of the body and are crossed by the water one and all,
 * each side is a trapezoid, with g along that axis: over [x0, x1] from the cap at y0 on,
 *     l(x) = (level - c up.n - x up.e) / up.g - y0,   a = l(x0),   b = l(x1),   L = x1 - x0,
 * with its centroid at x0 + L (a + 2b) / (3 (a + b)), y0 + (a^2 + ab + b^2) / (3 (a + b)); and a cap is
 * whole.  So is a body that is wholly wet: what is whole is not cut again as long as it stays so. */
#ifndef FL_WATER_FACET_CUT_H
#define FL_WATER_FACET_CUT_H
#include "base/wide.h"
#include "water/buoyancy.h"

/* Four facets, or parts of one; lanes that are left are zero. */
typedef struct {
    double n[3][FL_LANES], e[3][FL_LANES], g[3][FL_LANES], c[FL_LANES];
    double x0[FL_LANES], x1[FL_LANES]; /* of sides of a prism [m] */
    int32_t rows;                      /* pieces of each lane */
} fl_patches_four;

/* A piece of each of them; lanes that have fewer end in such of no area. */
typedef struct {
    double area[FL_LANES], x[FL_LANES], y[FL_LANES]; /* [m2], [m] */
} fl_patches_row;

/* Velocity of the fluid there along e, g and n, seen as v of the body is seen [m/s]. */
typedef struct {
    double u[3][FL_LANES];
} fl_patches_flow;

/* What there is of it now. */
enum fl_patches_state {
    FL_PATCHES_UNSEEN,
    FL_PATCHES_NONE,
    FL_PATCHES_WHOLE,
    FL_PATCHES_TOP,
    FL_PATCHES_BOTTOM,
    FL_PATCHES_ANYHOW
};

typedef struct {
    fl_patches_four *four; /* [fours] of [most] */
    fl_patches_row *row;   /* those of one four after those of another; room for [most_rows] */
    fl_patches_flow *flow; /* alike; NULL where no piece has another than the body */
    int32_t fours, most, most_rows;
    int dry;                     /* above the water, not below it */
    enum fl_patches_state state; /* TOP, BOTTOM: all sides of a prism, then that cap in a four of its own */
    int32_t upright;             /* then fl_facets.upright, else -1 */
} fl_patches;

/* The planes of the faces of a hull. */
typedef struct {
    fl_vec3 *axis;       /* [2 nf] e and g of each face */
    int32_t widest;      /* the face with the most corners */
    int32_t top, bottom; /* caps of a right prism along an axis of the body, or -1 */
    int32_t upright;     /* that axis, 0 to 2, or -1 */
    double y0, y1;       /* where they lie along it [m] */
    double reach;        /* max |x_v| [m] */
} fl_facets;

/* Of a hull with faces of its own.  -1 with FL_SYSTEM. */
int fl_facets_make(fl_facets *k, const fl_hull *h, fl_err *err);
void fl_facets_free(fl_facets *k); /* accepts a zeroed struct, leaves one */

/* Room for one, unseen.  flows: whether pieces have flows.  -1 with FL_SYSTEM, and it is to be freed. */
int fl_patches_make(fl_patches *s, const fl_hull *h, int dry, int flows, fl_err *err);
void fl_patches_free(fl_patches *s); /* accepts a zeroed struct, leaves one */

/* The surface below the plane up.x = level, above it with dry.  Leaves flow alone. */
void fl_patches_look(fl_patches *s, const fl_facets *k, const fl_hull *h, fl_vec3 up, double level);

/* How many bytes they take. */
double fl_facets_bytes(const fl_facets *k, const fl_hull *h);
double fl_patches_bytes(const fl_patches *s);

/* a along the axes e, g and n of the facet in lane l, and back. */
static inline fl_vec3 fl_patches_in(const fl_patches_four *f, int l, fl_vec3 a)
{
    return v3(v3_dot(v3(f->e[0][l], f->e[1][l], f->e[2][l]), a),
              v3_dot(v3(f->g[0][l], f->g[1][l], f->g[2][l]), a),
              v3_dot(v3(f->n[0][l], f->n[1][l], f->n[2][l]), a));
}

static inline fl_vec3 fl_patches_out(const fl_patches_four *f, int l, fl_vec3 a)
{
    const fl_vec3 e = v3(f->e[0][l], f->e[1][l], f->e[2][l]), g = v3(f->g[0][l], f->g[1][l], f->g[2][l]),
                  n = v3(f->n[0][l], f->n[1][l], f->n[2][l]);
    return v3_madd(v3_madd(v3_scale(a.x, e), a.y, g), a.z, n);
}

/* Place of the piece in lane l of a row, body axes [m]. */
static inline fl_vec3 fl_patches_place(const fl_patches_four *f, const fl_patches_row *row, int l)
{
    return fl_patches_out(f, l, v3(row->x[l], row->y[l], f->c[l]));
}

#endif
