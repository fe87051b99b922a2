/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_ply.h -- PLY 1.0: ascii, binary_little_endian, binary_big_endian. */
#ifndef FL_MESH_READ_PLY_H
#define FL_MESH_READ_PLY_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if the first line is "ply". */
int fl_ply_is(const fl_bytes *b);

/* Add the faces of b to s as the part `name`.  Read are the properties x, y, z of the element "vertex" and
 * the list vertex_indices or vertex_index of the element "face", at any position and of any type; all else is
 * ignored.  Faces of fewer than three corners are skipped.  Vertices must come before faces.
 * If faces have a property "part" of an integer type, each of its values is a part instead, in ascending
 * order, called as the header says in "comment part NUMBER NAME", or else part_NUMBER.  opt is not used: the
 * caller selects parts.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_ply_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
