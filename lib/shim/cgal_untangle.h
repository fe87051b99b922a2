/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_untangle.h -- surfaces that pass through each other or themselves, made into ones that do not. */
#ifndef FL_SHIM_CGAL_UNTANGLE_H
#define FL_SHIM_CGAL_UNTANGLE_H
#include "shim/cgal_repair.h"

typedef struct {
    int32_t joined;  /* closed bodies that became one with another: the union of both    */
    int32_t rebuilt; /* patches that passed through themselves, cut out there and closed anew */
    int32_t failed;  /* patches, or pairs of them, for which neither could be done        */
} fl_untangle;

/* Closed patches that look outward and pass through each other become their union, whose surface is that of
 * both but for new edges where they meet (rounded once).  A patch that passes through itself loses the
 * triangles concerned and some about them, and the hole is filled.  Open patches that pass through others
 * stay as they are.  Predicates are exact.
 *   s   x and t from malloc() or fl_alloc(); replaced where something was done
 * Returns 0, or -1 with FL_NUMERIC or FL_SYSTEM in err, and s as it was.
 * Source: Loriot et al., CGAL 5.5, corefinement and repair of self-intersections. */
int fl_cgal_untangle(fl_soup *s, fl_untangle *did, fl_err *err);

#endif
