/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rejected_formats.h -- formats that are recognised but not read, with advice on what to export instead. */
#ifndef FL_MESH_REJECTED_FORMATS_H
#define FL_MESH_REJECTED_FORMATS_H
#include "mesh/bytes.h"

/* A message like "a STEP file: ..." if b begins like STEP, IGES, BREP, DXF, Parasolid, glTF, FBX, 3MF and
 * other archives, HDF5 (MED, CGNS), NetCDF (Exodus), I-DEAS, MEDIT, Fluent, Radioss, LS-DYNA, DIODORE, MOSES,
 * OrcaFlex, VRML, PDF, or like ANSYS
 * commands without a block of nodes or elements; NULL for anything else.  Only the first bytes are examined.
 */
const char *fl_rejected_format(const fl_bytes *b);

#endif
