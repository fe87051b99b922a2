/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sesam_element.h -- element types of SESAM, as shapes with their order of nodes. */
#ifndef FL_MESH_SESAM_ELEMENT_H
#define FL_MESH_SESAM_ELEMENT_H
#include "mesh/elements.h"

enum { FL_SESAM_NODES = 20 };

typedef struct {
    int type;
    enum fl_shape shape;
    int truss;
    int8_t order[FL_SESAM_NODES]; /* node k of the shape is node order[k] of the element */
} fl_sesam_type;

/* The type of that number; NULL: it has no surface, or is unknown. */
const fl_sesam_type *fl_sesam_type_of(int type);

#endif
