/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_nodes.h -- nodes of an Abaqus deck. */
#ifndef FL_MESH_INP_NODES_H
#define FL_MESH_INP_NODES_H
#include "mesh/inp_model.h"

/* Data of the current keyword line:
 *     *NODE     number, x, y, z; with SYSTEM=C radius, degrees, z.  Placed by *SYSTEM and the instance
 *     *SYSTEM   origin and a point on the first axis, then a point in the plane of the first two axes; it
 *               holds until the next *SYSTEM
 *     *NGEN     first, last, increment: nodes at equal distances on the line between the two
 * 0, or -1 with FL_INPUT (spherical coordinates, arcs, collinear points, an undefined node) or FL_SYSTEM. */
int fl_inp_node(fl_inp_model *r, fl_err *err);
int fl_inp_system(fl_inp_model *r, fl_err *err);
int fl_inp_ngen(fl_inp_model *r, fl_err *err);

#endif
