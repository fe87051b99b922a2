/* SPDX-License-Identifier: GPL-3.0-or-later */
/* single_precision.h -- what 24 bits leave of coordinates far from the origin: 0.5 m at 6e6 m of UTM.
 *
 * Numbers of single precision of size x, 2^e <= x < 2^(e+1), are 2^(e-23) apart, and rounding moves x by up
 * to half of that.  What counts is the spacing over the size of the body. */
#ifndef FL_MESH_SINGLE_PRECISION_H
#define FL_MESH_SINGLE_PRECISION_H
#include "geom/surface.h"

/* Distance of neighbouring numbers of single precision at the largest coordinate of the box [m]. */
double fl_single_spacing(fl_aabb box);

/* Largest distance by which rounding to single precision moves a vertex of the part [m]. */
double fl_single_rounding(const fl_part *p);

/* True if every coordinate of s is a number of single precision and some are no whole numbers: they probably
 * were rounded to it. */
int fl_single_is_all(const fl_surface *s);

#endif
