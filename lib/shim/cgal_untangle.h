/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_untangle.h -- resolves intersections of surfaces with each other and with themselves. */
#ifndef FL_SHIM_CGAL_UNTANGLE_H
#define FL_SHIM_CGAL_UNTANGLE_H
#include "shim/cgal_repair.h"

/* Edges of a union shorter than this, relative to the diagonal of the box of all bodies, are removed. */
#define FL_UNTANGLE_SHORT_EDGE 1e-6
/* Largest relative enlargement of a body whose corners nearly coincide with those of another, so that
 * rounding would make the union intersect itself. */
#define FL_UNTANGLE_SWELL 1e-6

typedef struct {
    int32_t joined;  /* closed bodies united with another */
    int32_t rebuilt; /* self-intersecting patches that were cut out and filled */
    int32_t failed;  /* patches, or pairs of them, for which neither succeeded */
    double changed;  /* largest relative change of area or volume by a rebuilt patch */
} fl_untangle;

/* Closed bodies that intersect are replaced by their union, whose surface is that of both but for new edges
 * along the intersection.  Unions are computed exactly, two bodies at a time, then rounded, rid of short
 * edges and checked.  If the result is not valid, one of the bodies is enlarged slightly first
 * (FL_UNTANGLE_SHORT_EDGE, FL_UNTANGLE_SWELL).  A self-intersecting patch loses the triangles concerned and
 * some around them, and the hole is filled.  Open patches that intersect others are not changed.
 * A body that intersects another one is solid: one that lies in the union of others is dropped, whatever the
 * order of the bodies.  A body that intersects none may be a cavity and stays.
 *   s      x and t from malloc() or fl_alloc(); replaced if something was done
 *   shell  [s->nt] number of the body of each triangle: a body is not cut where others share its edges
 *   group  [s->nt as given] out: one shell of those that intersect, directly or through others
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM, and s unchanged.
 * Source: Loriot et al., CGAL 5.5, corefinement and repair of self-intersections. */
int fl_cgal_untangle(fl_soup *s, const int32_t *shell, int32_t *group, fl_untangle *did, fl_err *err);

#endif
