/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_stl.h -- STL, binary and ASCII. */
#ifndef FL_MESH_READ_STL_H
#define FL_MESH_READ_STL_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b is an STL file.
 *   binary   80 bytes, a 32-bit count n, then n records of 50 bytes.  The size decides, not the first word,
 *            which is "solid" in both kinds.  A count of 0 that was never filled in is accepted if the size
 *            fits.  Where the file goes on behind the head of b, a zero byte in the head decides; the reader
 *            then checks the size.
 *   ASCII    text that begins with "solid" */
int fl_stl_is(const fl_bytes *b);

/* Add the triangles of b to s: a binary file is one part called name; each solid of an ASCII file is a part
 * with the name of the solid, or else name.  Stored normals are ignored: the winding gives the outer side.
 * Each triangle has three vertices of its own; welding joins them.  opt is not used: the caller selects
 * parts.  Returns 0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_stl_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
