/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cleanup.h -- from what a file holds to what ice can meet: weld, orient, repair, simplify, measure. */
#ifndef STRUCT_IMPORT_CLEANUP_H
#define STRUCT_IMPORT_CLEANUP_H
#include "geom/moments.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "options.h"
#include "shim/cgal_crossing.h"
#include "shim/cgal_repair.h"
#include "shim/cgal_untangle.h"

struct mended {
    fl_moments came, went; /* as read and placed; as written */
    int came_closed;
    int32_t came_triangles;
    int32_t doubled; /* elements that stood on others, and did not come */
    fl_weld weld;
    fl_orient_counts orient;
    fl_repair repair;
    fl_untangle untangle;
    int32_t fins;       /* triangles of plates with two sides that went */
    int32_t walls;      /* triangles inside that went */
    int32_t simplified; /* triangles less */
    fl_crossing meet;   /* what is left */
    fl_mesh_quality left;
    int fits;              /* its open edges are those of other parts, and all of these close together */
    double strays, misses; /* no point of the result is farther from the source, and the other way [m] */
};

/* Mend a part in place, as far as o asks for it.  0, or -1 with FL_INPUT, FL_NUMERIC or FL_SYSTEM in err. */
int mend(fl_part *p, const struct options *o, struct mended *m, fl_err *err);

#endif
