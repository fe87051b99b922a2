/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_vtp.h -- the triangles of a surface as a VTK XML file of polygons (.vtp), for ParaView. */
#ifndef FL_MESH_WRITE_VTP_H
#define FL_MESH_WRITE_VTP_H
#include <stdio.h>
#include "geom/surface.h"

/* Version 1.0, arrays appended raw and uncompressed, little-endian, lengths of 64 bits, coordinates as
 * doubles. Points are shared within a part.  Cell data "part" (Int32) is the id of the part; the field data
 * "part_id" (Int32) and "part_name" (String) list ids and names.  Cones are not written: convert them to
 * triangles first.
 * Returns 0, or -1 with FL_INPUT if there are more corners than 32 bits can number; write errors show in
 * fl_out_close().
 * Source: VTK File Formats, in The VTK User's Guide, Kitware (2010), section 19.3. */
int fl_vtp_write(FILE *f, const fl_surface *s, fl_err *err);

#endif
