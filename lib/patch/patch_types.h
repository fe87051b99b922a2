/* SPDX-License-Identifier: GPL-3.0-or-later */
/* patch_types.h -- patch points: where the law `patch` (patch_law.h) acts, and the scratch to find them.
 *
 * A patch point is one term of U, or a share of one, that acts along one line.  A vertex gives one point, an
 * edge two and a face three; the two or three have force, torque and second moment of the term.  A and B are
 * the two cores; all points and directions are in the frame of B. */
#ifndef FL_PATCH_PATCH_TYPES_H
#define FL_PATCH_PATCH_TYPES_H
#include <stddef.h>
#include "geom/mat3.h"
#include "geom/poly.h"

typedef struct {
    double overlap; /* s                                                                       [m] */
    double u;       /* share of U; 0 for a rim force, which only moves the border of an area [m6] */
    double du, ddu; /* first and second derivative of the share with respect to s      [m5], [m4] */
    /* Direction: the force on A is dW/dU du n.  From B to A but for rim forces; a unit vector for vertices,
     * shorter where forces of several directions are summed, longer for faces that are not parallel. */
    fl_vec3 n;
    fl_vec3 unit_normal;   /* from B to A: direction of approach and of the pressure */
    fl_vec3 p;             /* middle of the overlap, on the line of the force [m] */
    double approach_speed; /* for the caller [m/s] */
    int32_t group_size;    /* consecutive points of one term: 2 of an edge, 3 of a face; 0: a single point */
} fl_patch_point;

/* One feature of a mesh among those that are summed into three points (mesh_under_face.h). */
typedef struct {
    int32_t first_point; /* first of the three                                                          */
    int32_t n;           /* points that stand for it: 1 triangle or corner, 2 edge, 3 larger face       */
    fl_vec3 p;           /* centre of its force                                                     [m] */
    fl_vec3 e1, e2;      /* points of equal second moment, n = 2: p +- e1; n = 3: p + e1 cos a + e2 sin a,
                          * a = 0, 120, 240 degrees                                                 [m] */
    double force;        /* its part of du along n                                                 [m5] */
} fl_patch_feature;

/* A core with vertices and normals in the frame of B.  Without faces: a point or a segment. */
typedef struct {
    const fl_poly *p;
    const fl_vec3 *v, *n; /* [p->nv], [p->nf] */
    double r;             /* dilation radius [m] */
    double side;          /* +1 for A, -1 for B */
} fl_patch_core;

/* Numbers of features of a core. */
typedef struct {
    int32_t *vertex, *edge, *face;
    int32_t vertices, edges, faces;
    int32_t vertex_cap, edge_cap, face_cap;
} fl_feature_set;

typedef struct fl_feature_pairs fl_feature_pairs; /* feature_pairs.h */

/* Table of distances of vertices from planes (plane_distances.h). */
typedef struct {
    double *h, *x;
    int32_t h_cap, x_cap;
} fl_distance_table;

/* Patch points of one contact, with the scratch of one thread.  Zeroed to start; grows as needed. */
typedef struct {
    fl_vec3 *va, *na; /* vertices and normals of A, see fl_patch_points_transform() */
    fl_mat3 M;        /* axes of A */
    fl_vec3 o;        /* origin of A */
    fl_feature_set near_a, near_b;
    fl_distance_table distances[2];
    fl_patch_point *point; /* [n] */
    fl_vec3 couple;        /* times dW/dU: moment on A besides those of the forces; minus it on B [m6] */
    fl_vec3 *polygon;      /* scratch of face_integral.c and cone_face.c */
    void *point_lanes, *area_motion; /* scratch of force_sum.c */
    struct fl_feature_draft *draft;  /* scratch of feature_pairs.c */
    struct fl_edge_integral *edges;  /* queue of edge_integral.c */
    fl_patch_feature *feature;       /* [features] of a mesh, in the order of point; see keep_features */
    int keep_features;               /* in: list the features of a mesh */
    int features, feature_cap;
    int32_t n; /* points */
    int32_t areas, va_cap, na_cap, point_cap, polygon_cap, point_lane_cap, area_cap;
} fl_patch_points;

/* Reserves memory for the vertices and normals of A; -1 when memory runs out. */
int fl_patch_points_reserve_core(fl_patch_points *w, const fl_poly *a);

/* Reserves memory for one more point; -1 when memory runs out. */
int fl_patch_points_grow(fl_patch_points *w);

/* Appends a point for the caller to fill; NULL when memory runs out. */
static inline fl_patch_point *fl_patch_points_next(fl_patch_points *w)
{
    if (w->n == w->point_cap && fl_patch_points_grow(w)) return NULL;
    return &w->point[w->n++];
}

static inline int fl_patch_points_add(fl_patch_points *w, fl_patch_point point)
{
    fl_patch_point *const to = fl_patch_points_next(w);
    if (!to) return -1;
    *to = point;
    return 0;
}

/* Appends a contact point of a law other than `patch`.  Only overlap, n, unit_normal, p and du are set.  du
 * is the multiplicity: 1 here; -1 for a saddle of the distance (structure/persistence_contact.h).
 *   x   point of A;  n: unit vector from B;  ra: dilation radius of A [m] */
int fl_patch_points_add_plain(fl_patch_points *w, fl_vec3 x, fl_vec3 n, double overlap, double ra);

void fl_feature_set_free(fl_feature_set *r);

#endif
