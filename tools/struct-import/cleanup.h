/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cleanup.h -- cleanup of an imported part: weld, orient, repair, simplify, remesh, measure. */
#ifndef STRUCT_IMPORT_CLEANUP_H
#define STRUCT_IMPORT_CLEANUP_H
#include "geom/enclosed_volume.h"
#include "geom/moments.h"
#include "geom/raise_deck.h"
#include "geom/mesh_patch.h"
#include "geom/weld.h"
#include "options.h"
#include "shim/cgal_crossing.h"
#include "shim/cgal_repair.h"
#include "shim/cgal_untangle.h"

struct cleanup {
    fl_moments before, after; /* as read and placed; as written */
    int was_closed;
    int32_t triangles_before;
    int32_t duplicates; /* elements of the file dropped as duplicates */
    fl_weld weld;
    fl_orient_counts orient;
    fl_repair repair;
    fl_untangle untangle;
    int32_t fins;                  /* triangles dropped from two-sided plates that stand on other triangles */
    int32_t walls;                 /* inner triangles dropped */
    int32_t contact_walls, sheets; /* triangles between bodies that touch; of two-sided plates apart */
    fl_volume_check volume;        /* of bodies that were united or rebuilt, 0 0 where there were none */
    int lost;                      /* the repaired surface encloses another volume than the bodies */
    int32_t simplified;            /* decrease of the number of triangles */
    fl_crossing crossing;          /* in the result */
    fl_mesh_quality quality;
    fl_deck_counts rim; /* rims at its top, if it is open */
    int closes_jointly; /* its open edges match those of other parts, and together these parts are closed */
    double deviation;   /* [m] largest distance of the result from the source */
    double rounding;    /* [m] by which the numbers of the output format move a vertex, included in both */
    double source_deviation; /* [m] largest distance of the source from the result */
};

/* Clean up a part in place, with the steps that o requests.  0, or -1 with FL_INPUT, FL_NUMERIC or FL_SYSTEM
 * in err. */
int clean_part(fl_part *p, const struct options *o, struct cleanup *m, fl_err *err);

#endif
