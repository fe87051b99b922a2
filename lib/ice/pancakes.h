/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pancakes.h -- floes that are round in plan: convex polygons of many sides inside their cells.
 *
 * With rho the radius of the cell's inscribed circle and D a distance from the cell's sides, the cell moved
 * inward by  D + q (rho - D)  is a convex polygon K, and K + B(r), r = q (rho - D), touches the cell moved
 * inward by D and has no corner sharper than a circle of radius r: the opening of the cell by that circle
 * (Serra, Image Analysis and Mathematical Morphology, 1982).  The core has S corners,
 *     x_k = s(u_k) + r u_k,    u_k = (cos, sin)(2 pi (k + phase) / S),
 * s(u) being the corner of K that is farthest along u: points of that rounded outline with S normals, one
 * step apart: it turns by less than 4 pi / S at each.  Moved outward by the dilation radius R a corner
 * goes R / cos(2 pi / S) away at most; with
 *     D = d + R / cos(2 pi / S)
 * no floe comes nearer to its cell's sides than d, and d is found such that all cover what was asked for.
 * q = FL_PANCAKES_ROUNDNESS; with 1 it would be circles. */
#ifndef FL_ICE_PANCAKES_H
#define FL_ICE_PANCAKES_H
#include "ice/floes.h"

#define FL_PANCAKES_ROUNDNESS 0.75

/* Fewest and most sides. */
enum { FL_PANCAKES_MIN_SIDES = 6, FL_PANCAKES_MAX_SIDES = 120 };

/* Floes of that many sides that cover  concentration  times the area of the cells, to rounding.  A small cell
 * keeps FL_FLOES_MIN_CORE of what it has to spare, and is held then.  inset of out is d.
 * Returns 0, or -1 with FL_INPUT: a cell is too small for the radius, or so many cannot be covered (how many
 * can is told); FL_SYSTEM.  out is untouched then. */
int fl_pancakes_make(fl_floes *out, const fl_power_cells *cells, int32_t sides, double concentration,
                     double radius, fl_vec2 shift, fl_err *err);

/* Mean over all floes of 4 pi area / outline^2, which is 1 for a circle. */
double fl_pancakes_circularity(const fl_floes *a);

#endif
