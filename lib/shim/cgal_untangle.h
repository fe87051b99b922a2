/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_untangle.h -- surfaces that pass through each other or themselves, made into ones that do not. */
#ifndef FL_SHIM_CGAL_UNTANGLE_H
#define FL_SHIM_CGAL_UNTANGLE_H
#include "shim/cgal_repair.h"

/* Edges of a union shorter than this part of the diagonal of the box of all are taken out of it. */
#define FL_UNTANGLE_SHORT_EDGE 1e-6
/* Bodies are swollen by up to about this part of their size where they meet in corners that lie in nearly one
 * place, so that a union would pass through itself once it is rounded. */
#define FL_UNTANGLE_SWELL 1e-6

typedef struct {
    int32_t joined;  /* closed bodies that became one with another: the union of both    */
    int32_t rebuilt; /* patches that passed through themselves, cut out there and closed anew */
    int32_t failed;  /* patches, or pairs of them, for which neither could be done        */
    double changed;  /* the most that a rebuilt patch changed its area or volume by, over it */
} fl_untangle;

/* Closed bodies that pass through each other become their union, whose surface is that of both but for new
 * edges where they meet: found exactly, two at a time, then rounded, rid of short edges and checked; where
 * it is not sound one of the two is swollen by a little first (FL_UNTANGLE_SWELL).  A body that passes
 * through others is solid, so that one that lies in the union of others is dropped, whatever the order of the
 * bodies; one that meets none may be a cavity, and stays.  A patch that passes through itself loses the
 * triangles concerned and some about them, and the hole is filled.  Open patches that pass through others
 * stay as they are.
 *   s      x and t from malloc() or fl_alloc(); replaced where something was done
 *   shell  [s->nt] which body a triangle is of, any number for each: none is cut where others share its
 *          edges
 *   group  [s->nt as it comes] out: a shell of the bodies that meet, directly or through others
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err, and s as it was.
 * Source: Loriot et al., CGAL 5.5, corefinement and repair of self-intersections. */
int fl_cgal_untangle(fl_soup *s, const int32_t *shell, int32_t *group, fl_untangle *did, fl_err *err);

#endif
