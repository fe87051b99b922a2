/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_vtk_xml.h -- XML files of VTK: PolyData (.vtp) and UnstructuredGrid (.vtu). */
#ifndef FL_MESH_READ_VTK_XML_H
#define FL_MESH_READ_VTK_XML_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Does b begin with an XML declaration, a comment or <VTKFile? */
int fl_vtk_xml_is(const fl_bytes *b);

/* Add the surface of the pieces of the file to s.  Arrays may be ascii, binary (base64) or appended (base64
 * or raw), of either byte order, with headers of 32 or 64 bits, packed by zlib or not.
 * Parts are the numbers of the first of the cell data in FL_VTK_PART_ARRAYS (vtk_cells.h) that is there; they are
 * called as the field data part_name and part_id say, as fl_vtp_write() leaves them, or else by name and
 * number.
 *   w   NULL wishes for everything
 * Returns 0, or -1 with FL_INPUT, which names the line or, in appended data, the byte (other packings, other
 * data sets and files of several files are refused by their word), or FL_SYSTEM; s may then have new
 * parts. */
int fl_vtk_xml_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
