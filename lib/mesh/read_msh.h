/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_msh.h -- Gmsh meshes: MSH 2 and 4.1, ASCII and binary of either byte order. */
#ifndef FL_MESH_READ_MSH_H
#define FL_MESH_READ_MSH_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b begins with a section of an MSH file: its word alone on a line, and a number on the next. */
int fl_msh_is(const fl_bytes *b);

/* Add the surface of the mesh to s.  Read are $PhysicalNames, $Entities, $PartitionedEntities, $Nodes,
 * $ParametricNodes and $Elements, in any order and any number; other sections are skipped.  Each physical
 * group is a part, called as in $PhysicalNames, or else curve_N, surface_N, volume_N by its tag; elements in
 * no group are the part `name`.  If an entity is in several groups, the first is its part, and each can be
 * selected as a set.  Of elements of order 3 and more only the corners are used, with a remark.
 *   opt   NULL selects everything
 * Returns 0, or -1 with FL_INPUT, which names the line or, in binary data, the byte (versions 4.0 and 1.0 and
 * truncated files are rejected), or FL_SYSTEM; s may then have new parts. */
int fl_msh_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
