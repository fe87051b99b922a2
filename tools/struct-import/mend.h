/* SPDX-License-Identifier: GPL-3.0-or-later */
/* mend.h -- from what a file holds to what ice can meet: weld, orient, repair, measure. */
#ifndef STRUCT_IMPORT_MEND_H
#define STRUCT_IMPORT_MEND_H
#include "geom/patch.h"
#include "geom/weld.h"
#include "shim/cgal_repair.h"

struct mended {
    fl_weld weld;
    fl_orient orient;
    fl_repair repair;
    fl_quality left;
};

/* Mend a part in place.  raw: weld only.  0, or -1 with FL_INPUT, FL_NUMERIC or FL_SYSTEM in err. */
int mend(fl_part *p, double weld, int32_t fill_holes, int raw, struct mended *m, fl_err *err);

#endif
