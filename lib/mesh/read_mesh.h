/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_mesh.h -- a mesh file of any kind that is known, told by what is in it. */
#ifndef FL_MESH_READ_MESH_H
#define FL_MESH_READ_MESH_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Add what path ("-" is standard input, gzip is unpacked) holds to s: STL (binary or ASCII), OBJ, OFF, PLY,
 * VTK (legacy or XML), g_struct, or a mesh of Abaqus, ANSYS, Gmsh or Nastran.  The kind is told by content,
 * never by name.  A part that has no name in the file is called by the file's base name up to its last dot
 * ("stdin" for the stream); parts without triangles and cones are dropped with a remark.  The history of a
 * g_struct file is appended to that of s.  Coordinates are as in the file: nothing is scaled, welded or
 * turned.
 *   w                    what is wished for only (import_options.h), NULL for everything; where parts are chosen by
 *                        name, none at all is an answer too
 *   note[FL_MESH_NOTE]   out: remarks for the user, each with its newline; also where nothing but "no
 *                        triangles" can be said, as they tell what was passed over
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err and s as it was. */
int fl_mesh_read(fl_surface *s, const char *path, fl_import_options *w, char *note, fl_err *err);

#endif
