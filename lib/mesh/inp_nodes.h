/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_nodes.h -- the nodes of an Abaqus deck. */
#ifndef FL_MESH_INP_NODES_H
#define FL_MESH_INP_NODES_H
#include "mesh/inp_model.h"

/* What stands behind the keyword line at hand:
 *     *NODE     number, x, y, z; with SYSTEM=C radius, degrees, z.  Moved as *SYSTEM and the instance say
 *     *SYSTEM   its origin and a point on its first axis, then a point beside that; nothing ends it
 *     *NGEN     first, last, step: nodes at equal steps on the line between the two
 * 0, or -1 with FL_INPUT (spherical coordinates, arcs, points on one line, a node that is not there) or
 * FL_SYSTEM. */
int fl_inp_node(fl_inp_model *r, fl_err *err);
int fl_inp_system(fl_inp_model *r, fl_err *err);
int fl_inp_ngen(fl_inp_model *r, fl_err *err);

#endif
