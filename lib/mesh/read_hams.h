/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_hams.h -- panels of HAMS (.pnl). */
#ifndef FL_MESH_READ_HAMS_H
#define FL_MESH_READ_HAMS_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has a comment on the number of panels and one that starts the nodes. */
int fl_hams_is(const fl_bytes *b);

/* Add the hull to s: under "# Number of Panels" NF NN sx sy, then between #Start and #End rows "id x y z" and
 * rows "no k n1 .. nk".  sx = 1 mirrors in x = 0, sy = 1 in y = 0.
 * Source: HAMS User's Manual, HullMesh.pnl.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_hams_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
