/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rejected_formats.h -- files that are handed over and not read: what they are, and what to export instead. */
#ifndef FL_MESH_REJECTED_FORMATS_H
#define FL_MESH_REJECTED_FORMATS_H
#include "mesh/bytes.h"

/* "a STEP file: ..." for what begins like STEP, IGES, DXF, Parasolid, glTF, FBX, 3MF and other archives, HDF5
 * (MED, CGNS), NetCDF (Exodus), I-DEAS, MEDIT, Fluent, Radioss, LS-DYNA, PDF, or like commands of ANSYS with
 * no block of nodes or elements; NULL for anything else.  Only its first bytes are looked at. */
const char *fl_rejected_format(const fl_bytes *b);

#endif
