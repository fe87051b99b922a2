/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_vtk.h -- legacy VTK files, ASCII and binary: POLYDATA and UNSTRUCTURED_GRID. */
#ifndef FL_MESH_READ_VTK_H
#define FL_MESH_READ_VTK_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b begins with "# vtk DataFile". */
int fl_vtk_is(const fl_bytes *b);

/* Add the surface of the data set to s; cells with counts (before version 5) and with offsets (version 5.1)
 * are read.  Parts are the values of the first array of cell data in FL_VTK_PART_ARRAYS (vtk_cells.h), given
 * as scalars or in a field; without one all cells are the part `name`.  Other data sets are rejected by name.
 *   opt   NULL selects everything
 * Returns 0, or -1 with FL_INPUT, which names the line or, in binary data, the byte, or FL_SYSTEM; s may then
 * have new parts. */
int fl_vtk_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
