/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_vtk.h -- legacy VTK files, ASCII and binary: POLYDATA and UNSTRUCTURED_GRID. */
#ifndef FL_MESH_READ_VTK_H
#define FL_MESH_READ_VTK_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Does b begin with "# vtk DataFile"? */
int fl_vtk_is(const fl_bytes *b);

/* Add the surface of the data set to s, with the counts of cells before version 5 and the offsets of
 * version 5.1.  Parts are the numbers of the first of the cell data in FL_VTK_PART_ARRAYS (vtk_cells.h) that is
 * there, as scalars or in a field; without one all is in a part called name.  Other data sets are refused by
 * their word.
 *   w   NULL wishes for everything
 * Returns 0, or -1 with FL_INPUT, which names the line or, in binary data, the byte, or FL_SYSTEM; s may then
 * have new parts. */
int fl_vtk_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
