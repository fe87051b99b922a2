/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_off.h -- the Object File Format of Geomview: OFF, COFF, NOFF, STOFF, 4OFF, or no word at all. */
#ifndef FL_MESH_READ_OFF_H
#define FL_MESH_READ_OFF_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Is the first word one of these, or are the first words of b three whole numbers alone on their row? */
int fl_off_is(const fl_bytes *b);

/* Add the faces of b to s as the part `name`.  A vertex is a row of x y z (4OFF: x y z w, taken as x/w y/w
 * z/w), a face a row of n and n indices from 0; what follows on the row (colours, normals) is passed over,
 * and so are faces of fewer than three corners.  Counts may stand beside the header word or below it; rows
 * that are missing are an error. 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_off_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
