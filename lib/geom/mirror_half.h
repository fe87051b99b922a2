/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mirror_half.h -- the other half of a surface of which a file holds one. */
#ifndef FL_GEOM_MIRROR_HALF_H
#define FL_GEOM_MIRROR_HALF_H
#include "geom/surface.h"

/* Adds the images of the triangles and cones of p in the plane where coordinate `axis` (0 x, 1 y) is 0, with
 * their winding reversed.  What lies in the plane, within tol [m], gets no twin, and vertices in the plane
 * are shared.  *crosses: out, the index of the first triangle that reaches through the plane or lies on the
 * other side of it than those before (of cone c: p->nt + c), -1 if there is none; else p is unchanged.
 * Returns 0, or -1 with FL_SYSTEM. */
int fl_part_mirror_half(fl_part *p, int axis, double tol, int32_t *crosses, fl_err *err);

#endif
