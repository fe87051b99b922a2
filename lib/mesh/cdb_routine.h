/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_routine.h -- element routines of ANSYS MAPDL and their shapes. */
#ifndef FL_MESH_CDB_ROUTINE_H
#define FL_MESH_CDB_ROUTINE_H
#include <stdint.h>

/* Shape family of a routine.  BRICK: a solid that always has 20 nodes, some of which may be 0. */
typedef enum {
    FL_CDB_NONE,
    FL_CDB_SOLID,
    FL_CDB_BRICK,
    FL_CDB_SHELL,
    FL_CDB_LINE,
    FL_CDB_CURVE
} fl_cdb_family;

/* Family of a routine, given by its number (185 for SOLID185); NONE if it is unknown or has no surface.  The
 * first key option decides the family of MESH200. */
fl_cdb_family fl_cdb_family_of(int32_t routine, int32_t key);

/* Shape (enum fl_shape) of an element of the family with n nodes, -1 if n is too small.  Nodes omitted at the
 * end are mid-side nodes. */
int fl_cdb_shape_of(fl_cdb_family family, int n);

#endif
