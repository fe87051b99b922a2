/* SPDX-License-Identifier: GPL-3.0-or-later */
/* region_cone.h -- cones in a contact region: those that continue one another, and where a cone is free.
 *
 * Two cones on one axis whose radii lie on one line r(z), and which meet or overlap, are one cone: the
 * division of a leg into members or parts leaves no trace.  Elsewhere a cone in a region is replaced by
 * its frustum (region.h).  Between the heights at which other members enter or touch it, it is free:
 * there the exact cone bears what is far enough from the ends of that interval. */
#ifndef FL_STRUCTURE_REGION_CONE_H
#define FL_STRUCTURE_REGION_CONE_H
#include "structure/structure.h"

/* If the cones a and b are one within tol [m], makes *both of it: 1.  Else 0; -1 with FL_SYSTEM. */
int fl_cones_unite(fl_piece *both, const fl_piece *a, const fl_piece *b, double tol, fl_err *err);

/* Finds the free intervals of cone piece[k], among the n pieces of its region.  Returns -1 with FL_SYSTEM. */
int fl_cone_find_free(fl_free_cone *out, int32_t n, const fl_piece *const *piece, int32_t k, double tol,
                      fl_err *err);

#endif
