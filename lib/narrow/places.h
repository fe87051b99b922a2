/* SPDX-License-Identifier: GPL-3.0-or-later */
/* places.h -- the places where two dilated convex cores touch, in the law `patch`.
 *
 * With R the sum of the radii, d(v, B) the signed distance of a vertex from the other core, and d(e, e') the
 * distance of two edges as clamped segments, the potential of a pair is
 *
 *   W = sum_{v of A} k phi(R - d(v,B)) + sum_{v of B} k phi(R - d(v,A))
 *     + sum_{e of A, e' of B} (k/4) m(c) phi(R - d(e,e')),     phi(s) = s^(n+1)/(n+1) for s > 0, else 0,
 *   c = |e^ x e'^|^2,   m(c) = (2 - c/E)(c/E) for c < E, else 1,  E = FL_PLACE_PARALLEL.
 *
 * Each term is one place.  A vertex has one distance from the whole core, and edges are clamped, never
 * tested for "interior", so W and its gradient are continuous from vertex to edge to face; m fades out edges
 * that become parallel, whose nearest points are not unique and whose ends (vertices) carry instead. The
 * force of a place is k w s^n along n through p; an edge place also carries a couple (see below). Source of
 * the fade: Li et al., Incremental Potential Contact, ACM TOG 39 (2020), in the public toolkit. */
#ifndef FL_NARROW_PLACES_H
#define FL_NARROW_PLACES_H
#include "geom/mat3.h"
#include "geom/poly.h"

#define FL_PLACE_PARALLEL 1e-3 /* c below which edges count as parallel: 1.8 degrees */
#define FL_PLACE_EDGE 0.25     /* share of an edge place in the stiffness of a vertex place */

typedef struct {
    int64_t key;    /* which vertex or pair of edges: the same place has the same key in every step */
    double overlap; /* R - d > 0                                                       [m] */
    double weight;  /* 1 for a vertex, m(c)/4 for a pair of edges; the derivative of W carries it */
    double store;   /* share of W it stands for: 1; 0 where only a force is meant */
    fl_vec3 n;      /* from B to A                                                          */
    fl_vec3 p;      /* middle of the overlap, on the line through the two nearest points [m] */
    fl_vec3 couple; /* times phi k: torque on A, its opposite on B, from the change of m; 0 for c >= E */
} fl_place;

/* Scratch of one thread, and the places found.  Zeroed to start; grows as it must. */
typedef struct {
    fl_vec3 *va; /* vertices of A in the frame of B; set by fl_places_enter() */
    int32_t *ea, *eb;
    fl_place *place;
    int32_t n; /* number of places */
    int32_t va_cap, ea_cap, eb_cap, place_cap;
} fl_places;

/* Turn the vertices of A into the frame of B: va = M v + o.  -1 when memory runs out. */
int fl_places_enter(fl_places *w, const fl_poly *a, fl_mat3 M, fl_vec3 o);

/* All places with positive overlap, in ascending key order, after fl_places_enter().
 *   a, b    cores in their own frames
 *   M, o    frame of A to frame of B
 *   ra, rb  dilation radii                                                                     [m]
 *   n       unit vector from B to A in the frame of B.  It only rules out: no place that counts has a reach
 *           along n beyond R, so any n gives the same places, and a separating one is quick.
 *   depth   D, by how much the cores overlap; 0 when they do not                                 [m]
 * Overlaps, points and normals are in the frame of B.  -1 when memory runs out. */
int fl_places_find(fl_places *w, const fl_poly *a, const fl_poly *b, fl_mat3 M, fl_vec3 o, double ra,
                   double rb, fl_vec3 n, double depth);

/* Append one term, for other shapes than two convex cores; -1 when memory runs out.
 * fl_places_vertex: the point x of A, or the point of A nearest to a vertex of B; n from B to A.
 * fl_places_edges: the term of edges a0 a1 of A and b0 b1 of B, which may not count; depth is D. */
int fl_places_vertex(fl_places *w, int64_t key, fl_vec3 x, fl_vec3 n, double overlap, double ra);
int fl_places_edges(fl_places *w, int64_t key, fl_vec3 a0, fl_vec3 a1, fl_vec3 b0, fl_vec3 b1, double ra,
                    double rb, double depth);

void fl_places_free(fl_places *w);

#endif
