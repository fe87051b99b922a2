/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_component.h -- components of elements of an ANSYS archive: named ranges of element numbers. */
#ifndef FL_MESH_CDB_COMPONENT_H
#define FL_MESH_CDB_COMPONENT_H
#include "mesh/elements.h"

typedef struct {
    int64_t lo, hi; /* element numbers, both included */
    int32_t set;    /* index in the sets of the mesh */
} fl_cdb_range;

typedef struct {
    fl_cdb_range *range; /* [n] */
    int32_t n, cap;
} fl_cdb_components;

/* Add the numbers lo .. hi to a component.  -1 with FL_SYSTEM. */
int fl_cdb_component_add(fl_cdb_components *c, int32_t set, int64_t lo, int64_t hi, fl_err *err);

/* Assign each element to the part named after the smallest component that holds it, the first of equals.  An
 * element in no component keeps its part.  With picks, each component also becomes a set that can be
 * selected.  Numbers without an element are ignored.  -1 with FL_SYSTEM. */
int fl_cdb_component_assign(fl_cdb_components *c, fl_elements *e, int picks, fl_err *err);

void fl_cdb_component_free(fl_cdb_components *c); /* accepts a zeroed struct, leaves one */

#endif
