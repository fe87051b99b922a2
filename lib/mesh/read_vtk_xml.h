/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_vtk_xml.h -- VTK XML files: PolyData (.vtp) and UnstructuredGrid (.vtu). */
#ifndef FL_MESH_READ_VTK_XML_H
#define FL_MESH_READ_VTK_XML_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b begins with an XML declaration, a comment or <VTKFile. */
int fl_vtk_xml_is(const fl_bytes *b);

/* Add the surface of all pieces of the file to s.  Arrays may be ascii, binary (base64) or appended (base64
 * or raw), of either byte order, with headers of 32 or 64 bits, compressed by zlib or not.  Parts are the
 * values of the first array of cell data in FL_VTK_PART_ARRAYS (vtk_cells.h).  The field data part_name and
 * part_id, as written by fl_vtp_write(), give their names; otherwise they are called by array and value.
 *   b     holds the whole file
 *   opt   NULL selects everything
 * Returns 0, or -1 with FL_INPUT, which names the line or, in appended data, the byte (other compressors and
 * data sets and files that refer to others are rejected by name), or FL_SYSTEM; s may then have new parts. */
int fl_vtk_xml_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
