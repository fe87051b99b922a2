/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_routine.h -- what the element routines of ANSYS MAPDL look like. */
#ifndef FL_MESH_CDB_ROUTINE_H
#define FL_MESH_CDB_ROUTINE_H
#include <stdint.h>

/* What a routine makes of its nodes.  BRICK: a solid that always has 20, some of them perhaps 0. */
typedef enum {
    FL_CDB_NONE,
    FL_CDB_SOLID,
    FL_CDB_BRICK,
    FL_CDB_SHELL,
    FL_CDB_LINE,
    FL_CDB_CURVE
} fl_cdb_family;

/* The family of a routine (of its number, 185 for SOLID185), NONE when it has no surface or is not known.
 * MESH200 is what its first key option says. */
fl_cdb_family fl_cdb_family_of(int32_t routine, int32_t key);

/* The shape (enum fl_shape) that a family makes of n nodes; -1 when that is too few.  Nodes that are left out
 * at the end are those in the middle of edges. */
int fl_cdb_shape_of(fl_cdb_family family, int n);

#endif
