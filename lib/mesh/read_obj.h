/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_obj.h -- Wavefront OBJ: vertices and polygons. */
#ifndef FL_MESH_READ_OBJ_H
#define FL_MESH_READ_OBJ_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if a row of b begins with "v" or "f", and all rows before it with words of OBJ. */
int fl_obj_is(const fl_bytes *b);

/* Add the faces of b to s.  Parts are the objects (o), or the groups (g) if the file has fewer than two
 * objects, or the materials (usemtl) if it has neither; other faces belong to the part `name`.  Indices start
 * at 1, negative ones count back from the latest vertex; texture and normal indices are ignored.  Free-form
 * surfaces and unknown words are counted in a remark; lines and points are skipped.  opt is not used: the
 * caller selects parts.  Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err. */
int fl_obj_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
