/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_salome_dat.h -- meshes of Salome (.dat): nodes and elements as numbers. */
#ifndef FL_MESH_READ_SALOME_DAT_H
#define FL_MESH_READ_SALOME_DAT_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if line 1 of b is two integers, of three nodes or more, line 2 the number 1 and three numbers. */
int fl_salome_dat_is(const fl_bytes *b);

/* Add the triangles and quadrilaterals to s: NN NE; rows "id x y z"; rows "id type nodes" with type 203 of
 * triangles and 204 of quadrilaterals, 206 and 208 of those with mid-side nodes, which are left out.  Lines
 * (102) and other types are counted.
 * Source: Salome, documentation of module Mesh, export to DAT.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_salome_dat_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
