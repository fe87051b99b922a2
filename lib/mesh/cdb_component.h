/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cdb_component.h -- components of elements of an ANSYS archive: ranges of numbers under a name. */
#ifndef FL_MESH_CDB_COMPONENT_H
#define FL_MESH_CDB_COMPONENT_H
#include "mesh/elements.h"

typedef struct {
    int64_t lo, hi; /* numbers of elements, both included */
    int32_t set;    /* of the sets of the mesh */
} fl_cdb_range;

typedef struct {
    fl_cdb_range *range; /* [n] */
    int32_t n, cap;
} fl_cdb_components;

/* Add the numbers lo .. hi to a component.  -1 with FL_SYSTEM. */
int fl_cdb_component_add(fl_cdb_components *c, int32_t set, int64_t lo, int64_t hi, fl_err *err);

/* Let each element be of the part that is called as the smallest component that holds it, the first of
 * equals; what is in none stays where it is.  With picks, each component can be wished for as a set.  Numbers
 * of elements that are not there are passed over.  -1 with FL_SYSTEM. */
int fl_cdb_component_assign(fl_cdb_components *c, fl_elements *e, int picks, fl_err *err);

void fl_cdb_component_free(fl_cdb_components *c); /* accepts a zeroed struct, leaves one */

#endif
