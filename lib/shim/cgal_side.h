/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_side.h -- which side of a closed surface a point is on, and distances from it, by CGAL: an oracle for
 * tests that shares nothing with lib/structure.
 *
 * The side is the parity of the crossings of a ray, by exact predicates (Side_of_triangle_mesh).  Distances
 * are those of triangles, searched in doubles and computed exactly for the nearest pair. */
#ifndef FL_SHIM_CGAL_SIDE_H
#define FL_SHIM_CGAL_SIDE_H
#include "shim/cgal_repair.h"

typedef struct fl_cgal_oracle fl_cgal_oracle;

/* Makes the oracle of a surface; s may be freed.  NULL with FL_NUMERIC or FL_SYSTEM. */
fl_cgal_oracle *fl_cgal_oracle_make(const fl_soup *s, fl_err *err);

/* 1 inside the surface, -1 outside, 0 on it; 0 as well if the surface is open. */
int fl_cgal_oracle_side(const fl_cgal_oracle *o, const double x[3]);

/* Distance of the surface from another one that is not empty, 0 if they meet [m]. */
double fl_cgal_oracle_distance(const fl_cgal_oracle *o, const fl_soup *other);

/* Distance of a point from the surface [m]. */
double fl_cgal_oracle_point_distance(const fl_cgal_oracle *o, const double x[3]);

void fl_cgal_oracle_free(fl_cgal_oracle *o); /* takes NULL */

#endif
