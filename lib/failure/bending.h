/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bending.h -- bending of a floe that is pressed at its rim, and where it breaks.
 *
 * From a load on the rim 15 directions e point inward, 11.25 degrees apart.  At distance x along e,
 *     sigma = 6 |M|/(b h^2) - N/(b h),     b = min(width of the floe there, w_c + 2 tan(30 deg) n x)
 *   M, N    moment and pressing force of the section across e                       [N m], [N]
 *   w_c, n  width of the contact, number of wedges of 60 degrees ahead of it         [m], 1
 *   h       thickness                                                                   [m]
 * and the floe breaks where sigma/s_f is largest, if it is above 1, s_f its flexural strength.
 *
 * Short floes, L < 1.5 l_b along e: statics.  All contact loads P_k at x_k are balanced by water, weight and
 * inertia, whose net load is the linear field
 *     q = a + g.x,      int q dA = -sum P,   int q x dA = -sum P x_k,
 * exact while the deck is dry and the bottom wet, in impact and at rest alike; M is the moment of loads and
 * field on the part cut off. Long floes: a beam of width b(x) on an elastic foundation k b, end load P and
 * end moment, 32 Hermite elements; the foundation ends where the floe leaves the water or floods.
 *     l_b = (E h^3/(3 k))^(1/4),    k = rho_w g
 * Without water all floes count as short.
 *
 * Sources: Hetenyi (1946), beam of finite length; Nevel (1961, 1972), wedges.  At a corner, a wedge and a
 * narrow contact the result is within -10 to +17 % of a plate. Limits: N above a third of sqrt(k E I) b,
 * near buckling, is not for this law; such loads are counted and do not break the floe. */
#ifndef FL_FAILURE_BENDING_H
#define FL_FAILURE_BENDING_H
#include "failure/plan_polygon.h"

typedef struct {
    double strength;   /* s_f [Pa] */
    double young;      /* E [Pa] */
    double foundation; /* k = rho_w g; 0: no water [N/m3] */
    double density;    /* of the ice over that of water; 0: the foundation has no end */
    int32_t wedges;
    double least_area; /* of what may be cut off, in plan [m2] */
} fl_bending_law;

typedef struct {
    double ratio;    /* sigma/s_f, 0: none */
    double ex, ey;   /* e */
    double c;        /* e.x of the section [m] */
    double moment;   /* |M| [N m] */
    double width;    /* b [m] */
    double distance; /* x [m] */
    double whole;    /* width of the floe there [m] */
    int buckles;     /* in some direction N is too large for the law, which then does not count */
    int small;       /* some section that would cut off less than least_area is above its strength */
} fl_bending;

enum { FL_BENDING_DIRECTIONS = 15 };

/* l_b of a floe of thickness h, INFINITY without water [m]. */
double fl_bending_length(const fl_bending_law *law, double h);

/* The largest sigma/s_f under load[k], the other n - 1 loads beside it. */
fl_bending fl_bending_of(const fl_plan *q, const fl_bending_law *law, const fl_plan_load *load, int32_t n,
                         int32_t k);

/* Beam on its foundation: end load P [N] (upwards) and end moment C at x = 0, of length L, width[] at the
 * FL_BEAM_NODES nodes; M at the nodes and deflection at the end. */
enum { FL_BEAM_NODES = 33 };
double fl_beam_node(double L, int n); /* place of node n: L (n/32)^2 [m] */
void fl_bending_beam(const fl_bending_law *law, double h, double L, const double width[FL_BEAM_NODES],
                     double P, double C, double M[FL_BEAM_NODES], double *deflection);

#endif
