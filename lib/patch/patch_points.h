/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_points.h -- the places where two dilated convex cores touch, and the law `patch` built on them.
 *
 * With R the sum of the radii, d(x, B) the distance of a point from the other core and s = R - d its overlap,
 *
 *     W = c sqrt(U),     c = E* beta / sqrt(pi),     U = sum over the features of both cores of
 *
 *     faces      1/2 m int s^4 dA          over a face of the other, m = (1 - 4 sin^2)^2 of the
 *                                              angle between them, 0 beyond 30 degrees
 *     edges      w L (256/315) sqrt(2 rho) int s^(9/2) dl
 *     vertices   w L (2 pi/5) rho s^5,                            L = 32/45 / beta^2,
 *
 * rho the own radius (the other's where the own is 0), w = 1 but for edges and vertices that are hardly bent.
 * The three rows are the same integral int s^4 dA over the contact of a flat, of a cylinder and of a ball of
 * radius rho: one measure of a patch, whatever its kind.  What it gives, and why it is the law:
 *   - s is the distance to a whole convex body, so that no kind of contact is ever decided: W has a
 *     continuous gradient, which is the force, from vertex to edge to face and over every rim.
 *   - A face carries as a flat punch, K = 2 E* beta sqrt(A/pi), (25) of the manual; rocking, as 9/8 of one
 *     (a punch has (2/3) a^2 K, int s^4 gives (3/4) a^2 K).  The power 4 is the only one of which the root
 *     does the first, and it does the second almost for nothing.
 *   - A vertex on a face is Hertz' contact, exactly: (8/15) E* sqrt(rho) s^(5/2).
 *   - Every pressure is positive, and more contact is never less energy.
 *   - U is a sum over pieces of surface: a wall of 2 triangles is one of 20 000.
 * Long line contacts come out too soft, as sqrt(length): at 1 m, 50 mm radius and 1 mm overlap 3 times softer
 * than a rigid strip on a half-space.  Two edges that cross, and two vertices, are counted from both sides:
 * up to 1.7 and 1.4 times as stiff as Hertz.  A face leaves the rim of another with a jump of the force along
 * the face of s/(4 sqrt A) of the force across it: its strip beyond the rim, sqrt(2 R s) wide, is the edge's.
 *
 * Tried and left: springs at the corners of the overlap (stiffness follows the number of corners, not the
 * area: aligned equal faces 5.6 times as stiff as offset ones); S^(3/2)/V with S = int s^2, V = int s (pulls
 * at shallow spots); point at the nearest points (jumps on parallel faces by F times their size). */
#ifndef FL_PATCH_PATCH_POINTS_H
#define FL_PATCH_PATCH_POINTS_H
#include <stddef.h>
#include "geom/mat3.h"
#include "geom/poly.h"
#include "narrow/penetration.h"

#define FL_PATCH_RIM_WIDTH 0.1 /* width of the fading rim of a face, over R */
#define FL_PATCH_BETA 1.02     /* of a polygonal punch: circle 1, square 1.012, triangle 1.034 */
#define FL_PATCH_ROUND_FACTOR (32.0 / 45.0 / (FL_PATCH_BETA * FL_PATCH_BETA)) /* L */
#define FL_PATCH_EDGE_WEIGHT (1.0 / FL_POLY_BLUNT_EDGE)     /* w = bend times this [1/rad], at most 1 */
#define FL_PATCH_CORNER_WEIGHT (1.0 / FL_POLY_BLUNT_CORNER) /* w = defect times this [1/sr], at most 1 */

/* A part of U that pulls along one line: a vertex, or a piece of an edge or of a face, of which two or three
 * have the force, the torque and the spread. */
typedef struct {
    double overlap; /* s                                                                    [m] */
    double u;       /* share of U; 0 for the pull of rims, that only moves the border    [m6] */
    double du, ddu; /* derivatives of the share after s                                  [m5], [m4] */
    fl_vec3 n; /* the force on A is dW/dU du n; from B to A but for rims.  Unit for vertices; shorter where
                * forces of many directions meet, longer for faces that are not parallel */
    fl_vec3 unit_normal;   /* unit, from B to A: what bodies approach along, and press */
    fl_vec3 p;             /* middle of the overlap, on the line of that force [m] */
    double approach_speed; /* for the caller: speed of approach here [m/s] */
    int32_t
        group_size; /* so many places in a row stand for one strip (2), one area (3); 0: for itself alone */
} fl_patch_point;

/* Three places that stand for an area may be made of many features: one of those. */
typedef struct {
    int32_t first_point; /* the first of the three                                         */
    int32_t n;           /* 1: one triangle or a corner; 2: an edge; 3: a larger face      */
    fl_vec3 p;           /* where the feature bears                                    [m] */
    fl_vec3 e1, e2;      /* 2: places at p +- e1 have its spread; 3: three at p + e1 cos a + e2 sin a [m] */
    double force;        /* its part of du, along n                                   [m5] */
} fl_patch_feature;

/* A core in the frame that both are looked at in.  Zero faces: a point or a segment. */
typedef struct {
    const fl_poly *p;
    const fl_vec3 *v, *n; /* [p->nv], [p->nf] in the common frame */
    double r;             /* dilation radius [m] */
    double side;          /* +1 for A, -1 for B */
} fl_patch_core;

/* Features worth a look. */
typedef struct {
    int32_t *vertex, *edge, *face;
    int32_t vertices, edges, faces;
    int32_t vertex_cap, edge_cap, face_cap;
} fl_feature_set;

typedef struct fl_feature_pairs fl_feature_pairs; /* feature_pairs.h */

/* A table of heights in work (feature_pairs.h). */
typedef struct {
    double *h, *x;
    int32_t h_cap, x_cap;
} fl_distance_table;

/* Scratch of one thread, and the places found.  Zeroed to start; grows as it must. */
typedef struct {
    fl_vec3 *va,
        *na;   /* vertices and normals of A in the frame of B; set by fl_patch_points_transform() with */
    fl_mat3 M; /* the frame of A in that of B, and */
    fl_vec3 o; /* its origin */
    fl_feature_set near_a, near_b;
    fl_distance_table distances[2];
    fl_patch_point *point;
    fl_vec3 couple;   /* times dW/dU: a moment on A beside those of the forces, its opposite on B [m6] */
    fl_vec3 *polygon; /* of face_integral.c: polygons while they are cut */
    void *point_lanes,
        *area_motion; /* of force_sum.h, for the caller: places and areas, four and one at a time */
    struct fl_feature_draft *draft; /* of feature_pairs.c: a list in work */
    struct fl_edge_integral *edges; /* of edge_integral.c: edges that wait */
    fl_patch_feature
        *feature; /* of a surface (mesh_under_face.h), in the order of place; only where apart is set */
    int keep_features, features, feature_cap;
    int32_t n; /* number of places */
    int32_t areas, va_cap, na_cap, point_cap, polygon_cap, point_lane_cap, area_cap;
} fl_patch_points;

/* Turn the vertices and normals of A into the frame of B: va = M v + o, na = M n.  -1 when memory runs out.
 */
int fl_patch_points_transform(fl_patch_points *w, const fl_poly *a, fl_mat3 M, fl_vec3 o);

/* Room for those of A; -1 when memory runs out. */
int fl_patch_points_reserve_core(fl_patch_points *w, const fl_poly *a);

/* All places of two cores that do not overlap, in a fixed order, after fl_patch_points_transform().
 *   a, b    cores in their own frames
 *   ra, rb  dilation radii                                                                     [m]
 *   n       unit vector from B to A in the frame of B.  It only rules out: whatever it is, the places are the
 *           same, and one that separates the cores by nearly their distance is quick.
 *   deep    by how much the cores overlap, depth 0 when they do not; n is the way out then
 *   l       the matches of this pair, made anew when they are out of date
 * Cores that overlap by D are looked at as if moved apart by D n, with s = R + D - d; D and the turning of n
 * have places of their own.
 * Points and directions are in the frame of B.  -1 when memory runs out. */
int fl_patch_points_find(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                         fl_vec3 n, const fl_penetration *deep, fl_feature_pairs *l);

/* The same where l holds, M and o being as fl_patch_points_transform() has them, and tells that the cores do not meet;
 * A need not have been entered. */
int fl_patch_points_find_listed(fl_patch_points *w, const fl_poly *a, const fl_poly *b, double ra, double rb,
                                fl_mat3 M, fl_vec3 o, const fl_feature_pairs *l);

/* All places of A over the half-space z < 0 of the frame of B, and the least z of A's core. */
int fl_patch_points_on_plane(fl_patch_points *w, const fl_poly *a, double ra, double *distance);

/* --- for those who put places together ------------------------------------------------------ */

int fl_patch_points_grow(fl_patch_points *w); /* for one more; -1 when memory runs out */

/* The next one, to be written where it lies; NULL when memory runs out. */
static inline fl_patch_point *fl_patch_points_next(fl_patch_points *w)
{
    if (w->n == w->point_cap && fl_patch_points_grow(w)) return NULL;
    return &w->point[w->n++];
}

static inline int fl_patch_points_add(fl_patch_points *w, fl_patch_point place)
{
    fl_patch_point *const to = fl_patch_points_next(w);
    if (!to) return -1;
    *to = place;
    return 0;
}

void fl_feature_set_free(fl_feature_set *r);

/* The radius that a feature of a core of radius r shows to one of radius other. */
static inline double fl_patch_feature_radius(double r, double other) { return r > 0.0 ? r : other; }

/* A vertex of `own` at x, of which the nearest point of the other core lies at x - d n. */
int fl_patch_points_add_vertex(fl_patch_points *w, const fl_patch_core *own, double other, int32_t v,
                               fl_vec3 n, double overlap);

/* A place of a law that is not `patch`: only overlap, n, p and du are set, which is how often it counts: 1,
 * or -1 where that is taken off which two walls share (structure/persistence_contact.h).  x: the point of A. */
int fl_patch_points_add_plain(fl_patch_points *w, fl_vec3 x, fl_vec3 n, double overlap, double ra);

void fl_patch_points_free(fl_patch_points *w);

#endif
