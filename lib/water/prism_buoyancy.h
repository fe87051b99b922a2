/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prism_buoyancy.h -- still water round a right prism of which it crosses every long edge: the usual floe, afloat.
 *
 * With e along the long edges, q the place in the cross-section (area A, second moments J about its centroid,
 * perimeter P with centroid g), the caps at z0 < z1 along e and up = u + u_e e, u_e > 0, the water stands at
 *     z(q) = z_w + s.q,     s = -u / u_e,     l(q) = z(q) - z0,
 * and the part below it is
 *     V     = A l(0)
 *     V x_B = int q l dA + e int (z^2 - z0^2)/2 dA = J s + e (A (z_w - z0)(z_w + z0) + s.J s)/2
 *     A_wet = A + P l(g),     A_w = A / u_e:
 * a few products, where the faces of a solid would have to be cut one by one (buoyancy.h); the same to
 * rounding. */
#ifndef FL_WATER_PRISM_BUOYANCY_H
#define FL_WATER_PRISM_BUOYANCY_H
#include "geom/poly.h"

typedef struct {
    double area;   /* A; 0: not a right prism                              [m^2] */
    fl_vec3 o;     /* on the line of the centroids, z = 0                    [m] */
    fl_vec3 a, e;  /* unit, at right angles: the first axis of q, and the long one; e x a is the second */
    double z0, z1; /* [m] */
    double jaa, jab, jbb; /* J                                                    [m^4] */
    double perimeter;     /* P                                                      [m] */
    double ga, gb;        /* g                                                      [m] */
    double far2;          /* largest |q|^2                                        [m^2] */
} fl_prism;

/* Of several ways to see p as a right prism, as of a box, the one with the shortest long edges.  out->area is
 * 0 when there is none: edges must be parallel, and caps at right angles to them, within 1e-12 of the
 * size, and each cap one face. */
void fl_prism_of(fl_prism *out, const fl_poly *p);

struct fl_submerged; /* buoyancy.h */

/* The part below up.x = level; 0, and nothing set, where the water may touch a cap. */
int fl_prism_submerged(const fl_prism *p, fl_vec3 up, double level, struct fl_submerged *wet);

#endif
