/* SPDX-License-Identifier: GPL-3.0-or-later */
/* hulls.h -- structures made by code, which are not convex, and where a body is to them by brute force. */
#ifndef FL_TESTS_HULLS_H
#define FL_TESTS_HULLS_H
#include "base/rng.h"
#include "geom/poly.h"
#include "geom/surface.h"

enum { HULLS = 36 };

/* Adds the k-th structure, 0 <= k < HULLS, as one part: raked bows of few triangles, ships with flare and
 * bulb, barges with moonpools, thin fins, jackets of many tubes, bumpy balls, a hull with a cavity, a tank,
 * and open shells, in several proportions and with random diagonals of their quadrilaterals. Returns 1 if it
 * is closed, 0 if it is an open shell. */
int hull_make(fl_surface *s, int k);
const char *hull_name(int k);

/* Winding number of the triangles about x: sum of the solid angles over 4 pi. Of a tank, plus 1. */
double hull_winding(const fl_part *p, fl_vec3 x);

/* Distance of a convex core from the triangles, 0 if one of them meets the core. All features against all. */
double hull_distance(const fl_part *p, const fl_poly *core);

/* Distance of a point from the triangles. */
double hull_point_distance(const fl_part *p, fl_vec3 x);

#endif
