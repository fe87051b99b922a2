/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_ply.h -- PLY 1.0: ascii, binary_little_endian, binary_big_endian. */
#ifndef FL_MESH_READ_PLY_H
#define FL_MESH_READ_PLY_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Is the first line "ply"? */
int fl_ply_is(const fl_bytes *b);

/* Add the faces of b to s as the part `name`: properties x, y, z of the element "vertex" and the list
 * vertex_indices or vertex_index of the element "face", wherever they stand and of whatever type; all else is
 * passed over.  Faces of fewer than three corners are passed over too.  Vertices must come before faces.
 * Where faces have a property "part" of a whole type there is a part for each of its numbers instead, in
 * their order, called as the header says in "comment part NUMBER NAME", or else part_NUMBER.
 * 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_ply_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
