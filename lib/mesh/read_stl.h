/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_stl.h -- STL, binary and ASCII. */
#ifndef FL_MESH_READ_STL_H
#define FL_MESH_READ_STL_H
#include "geom/surface.h"
#include "mesh/bytes.h"

/* Is this a binary STL?  80 bytes, a 32-bit count n, n records of 50 bytes: the size decides, not the first
 * word, which is "solid" in both kinds.  A file whose count was never filled in (0) is binary by its size
 * alone.  Of one that goes on behind the head of b zero bytes decide, and its size is looked at by the
 * reader. */
int fl_stl_is_binary(const fl_bytes *b);

/* Add the triangles of b to s: one part called `name` from a binary file, a part a solid from an ASCII one,
 * under the name of the solid or else `name`.  Stored normals are not looked at: the winding gives the side.
 * Each triangle brings its own three vertices: weld.  0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_stl_read_binary(fl_surface *s, fl_bytes *b, const char *name, fl_err *err);
int fl_stl_read_ascii(fl_surface *s, fl_bytes *b, const char *name, fl_err *err);

#endif
