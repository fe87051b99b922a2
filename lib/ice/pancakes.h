/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pancakes.h -- pancake ice: floes round in plan, convex polygons of many sides inside their cells.
 *
 * Let rho be the inscribed radius of a cell and D a distance from its sides.  The cell moved inward by D +
 * q (rho - D) is a convex polygon K. The set K + B(r), r = q (rho - D), touches the cell moved inward by D
 * and has no corner sharper than a circle of radius r: it is the opening of the cell by that circle
 * (Serra, Image Analysis and Mathematical Morphology, 1982).  The core has S corners
 *    x_k = s(u_k) + r u_k,    u_k = (cos, sin)(2 pi (k + phase) / S),
 * s(u) being the corner of K farthest along u.  They are points of the rounded outline with S equally
 * spaced normals, and the polygon turns by less than 4 pi / S at each.  Moved outward by the dilation
 * radius R, a corner moves by at most R / cos(2 pi / S).  With
 *    D = d + R / cos(2 pi / S)
 * no floe is nearer to the sides of its cell than d, and d is found such that the floes have the requested
 * concentration. q = FL_PANCAKES_ROUNDNESS; q = 1 would give circles. */
#ifndef FL_ICE_PANCAKES_H
#define FL_ICE_PANCAKES_H
#include "ice/floes.h"

#define FL_PANCAKES_ROUNDNESS 0.75

/* Range of the number of sides. */
enum { FL_PANCAKES_MIN_SIDES = 6, FL_PANCAKES_MAX_SIDES = 120 };

/* Floes with that many sides that cover `concentration` times the area of the cells, to rounding.  A small
 * cell keeps FL_FLOES_MIN_CORE of its spare radius, and its floe is limited. out->inset is d.  Returns 0,
 * or -1 with FL_INPUT (a cell is too small for the radius, or the concentration is out of reach; the
 * message gives the range) or FL_SYSTEM; out is unchanged then. */
int fl_pancakes_make(fl_floes *out, const fl_power_cells *cells, int32_t sides, double concentration,
                     double radius, fl_vec2 shift, fl_err *err);

/* Mean over all floes of 4 pi area / perimeter^2, which is 1 for a circle. */
double fl_pancakes_circularity(const fl_floes *a);

#endif
