/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_routine.h -- element routines of ANSYS MAPDL and their shapes. */
#ifndef FL_MESH_CDB_ROUTINE_H
#define FL_MESH_CDB_ROUTINE_H
#include <stdint.h>

/* Shape family of a routine.  SOLID: bricks of 8 nodes and what they collapse to; BRICK: a solid that always
 * has 20 nodes, some of which may be 0; TET: tetrahedra of 4 or 10; SHELL: quadrilaterals of 4 or 8; TRI:
 * triangles of 3 or 6. */
typedef enum {
    FL_CDB_NONE,
    FL_CDB_SOLID,
    FL_CDB_BRICK,
    FL_CDB_TET,
    FL_CDB_SHELL,
    FL_CDB_TRI,
    FL_CDB_LINE,
    FL_CDB_CURVE
} fl_cdb_family;

/* Family of a routine, given by its number (185 for SOLID185); NONE if it is unknown or has no surface, and
 * of fluids and acoustic elements, which are not structure.  The first key option decides the family of
 * MESH200 and PLANE183. */
fl_cdb_family fl_cdb_family_of(int32_t routine, int32_t key);

/* Shape (enum fl_shape) of an element of the family with the nodes node[0 .. n), -1 if n is too small.  The
 * family decides: beyond the corners n tells only which mid-side nodes are omitted at the end, so that 8 or 9
 * nodes of a tetrahedron make a TET10, and 10 of a brick a HEX20. */
int fl_cdb_shape_of(fl_cdb_family family, int n, const int64_t *node);

#endif
