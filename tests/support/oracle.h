/* SPDX-License-Identifier: GPL-3.0-or-later */
/* oracle.h -- reference distance and penetration of two convex bodies by brute force in long double. */
#ifndef FL_TESTS_ORACLE_H
#define FL_TESTS_ORACLE_H
#include "narrow/penetration.h"

typedef long double real;

typedef struct {
    real d;      /* distance, or minus the penetration depth  [m] */
    real n[3];   /* unit, from b to a; of equal depths the first  */
    real unsure; /* how far n may be off by the conditioning of the features it comes from [rad] */
} oracle_gap;

/* All vertices of one body against all triangles of the other, all edges against all edges, all vertices
 * against edges and vertices.  Among the nearest pairs the one is taken whose planes, normal to the line of
 * its points, leave both bodies outside.  If those planes do not separate the bodies, they meet: then the
 * least width over all face normals and all products of edges is the depth.  Sizes are of order 1. */
void oracle_distance(const fl_solid *a, const fl_solid *b, oracle_gap *out);

/* Angle of the direction n to that of the features, for any features that the rounding of coordinates
 * allows.  It is the smallest angle to the direction of a pair of features at the distance d of *o whose
 * planes leave all but 4 * 2^-53 of the size outside. */
real oracle_off(const fl_solid *a, const fl_solid *b, const oracle_gap *o, fl_vec3 n);

/* The gap between the planes normal to n: min over a of n.x - max over b of n.y, in long double. */
real oracle_room(const fl_solid *a, const fl_solid *b, fl_vec3 n);

#endif
