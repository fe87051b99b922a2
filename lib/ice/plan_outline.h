/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plan_outline.h -- the outline of a closed mesh in plan between two levels, as one ring with few sides.
 *
 * The ring is the section of the mesh at the one of FL_PLAN_LEVELS levels where its area is largest.  It then
 * gets fewer sides, which only move outward: a corner that turns inward is bridged, or a side is dropped and
 * its neighbours are extended until they meet, the least of these steps first, as long as it is shorter than
 * `coarse`.  Inner loops of a section (a moonpool) are filled. */
#ifndef FL_ICE_PLAN_OUTLINE_H
#define FL_ICE_PLAN_OUTLINE_H
#include "geom/surface.h"
#include "ice/domain.h"

enum { FL_PLAN_LEVELS = 5 };

/* Add the outline of the triangles tri[n] of part p between z0 and z1, moved outward by `margin` [m], to the
 * domain as a hole.
 *    *made  out: 0 if there is no such outline, and the caller has to surround the triangles otherwise
 * There is none where the mesh is open between the levels, has several outer loops or leans out of its
 * section by more than `coarse`, and where the ring moved outward meets itself. Returns 0, or -1 with
 * FL_SYSTEM. */
int fl_plan_outline_add(fl_domain *d, const fl_part *p, int32_t n, const int32_t *tri, double z0, double z1,
                        double margin, double coarse, int *made, fl_err *err);

#endif
