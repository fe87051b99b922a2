/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_off.h -- the Object File Format of Geomview: header OFF, COFF, NOFF, STOFF, 4OFF, or none. */
#ifndef FL_MESH_READ_OFF_H
#define FL_MESH_READ_OFF_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if the first word is one of these, or if the first row of b is three integers. */
int fl_off_is(const fl_bytes *b);

/* Add the faces of b to s as the part `name`.  A vertex is x y z (4OFF: x y z w, read as x/w y/w z/w), a
 * face n and n indices from 0; its numbers may stand on several lines.  The rest of the line behind it
 * (colours, normals) and faces of fewer than three corners are ignored.  Counts may stand beside the header
 * word or below it; missing vertices and faces are an error.
 * opt is not used: the caller selects parts.  Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_off_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
