/* SPDX-License-Identifier: GPL-3.0-or-later */
/* voronoi.h -- cores of floes as voronoi-ice makes them: prisms over cells of n sites, smoothed twice. */
#ifndef FL_TESTS_VORONOI_H
#define FL_TESTS_VORONOI_H
#include "geom/poly.h"

/* n of them, in a square in which each has `area` [m2] and all together, dilated by radius, cover the part
 * `concentration`; from z0 to z1.  Failures end the program with the sentence. */
void voronoi_cores(fl_poly *out, int32_t n, double area, double concentration, double radius, double z0,
                   double z1);

#endif
