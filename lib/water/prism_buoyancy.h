/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prism_buoyancy.h -- hydrostatics of a right prism whose long edges all cross the water plane: the usual
 * floe.
 *
 * Let e be the direction of the long edges and q the position in the cross-section. The section has the area
 * A, second moments J about its centroid, and the perimeter P with centroid g. The caps are at z0 < z1 along
 * e, and up = u + u_e e, u_e > 0. The water surface is at
 *     z(q) = z_w + s.q,     s = -u / u_e,     l(q) = z(q) - z0,
 * and the part below it has
 *     V     = A l(0)
 *     V x_B = int q l dA + e int (z^2 - z0^2)/2 dA = J s + e (A (z_w - z0)(z_w + z0) + s.J s)/2
 *     A_wet = A + P l(g),     A_w = A / u_e.
 * These few products replace cutting the faces one by one (buoyancy.h), with the same result to rounding. */
#ifndef FL_WATER_PRISM_BUOYANCY_H
#define FL_WATER_PRISM_BUOYANCY_H
#include "geom/poly.h"
#include "water/submerged.h"

/* Least |u_e| of the formulae. They divide by u_e, which at 0.1 (long edges 84 degrees off the vertical)
 * loses one digit. Below it the faces are cut one by one. */
#define FL_PRISM_MIN_UPRIGHT 0.1

typedef struct {
    double area; /* A; 0: not a right prism [m^2] */
    fl_vec3 o;   /* point on the line of section centroids, z = 0 [m] */
    /* unit and orthogonal: first axis of q, and the long edges; e x a is the second axis of q */
    fl_vec3 a, e;
    double z0, z1;        /* [m] */
    double jaa, jab, jbb; /* J [m^4] */
    double perimeter;     /* P [m] */
    double ga, gb;        /* g [m] */
    double far2;          /* largest |q|^2 [m^2] */
} fl_prism;

/* Finds the right prism that p is; of several, as in a box, the one with the shortest long edges. out->area
 * is 0 if there is none: edges must be parallel and caps normal to them, within 1e-12 of the size, and each
 * cap one face. */
void fl_prism_of(fl_prism *out, const fl_poly *p);

/* The part below up.x = level. Returns 0, and sets nothing, if the water may touch a cap. */
int fl_prism_submerged(const fl_prism *p, fl_vec3 up, double level, fl_submerged *wet);

#endif
