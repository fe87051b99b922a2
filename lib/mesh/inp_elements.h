/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_elements.h -- elements of an Abaqus deck. */
#ifndef FL_MESH_INP_ELEMENTS_H
#define FL_MESH_INP_ELEMENTS_H
#include "mesh/inp_model.h"

/* Data of the current keyword line:
 *     *ELEMENT   number and nodes, over as many lines as needed.  The set of ELSET= is the part.  Elements of
 *                a type without a surface are counted
 *     *ELGEN     the master element; then how many in a row, and the increments of nodes and numbers; the
 *                same for rows, and for layers of rows
 * 0, or -1 with FL_INPUT (too few or too many nodes, an undefined element) or FL_SYSTEM. */
int fl_inp_element(fl_inp_model *r, fl_err *err);
int fl_inp_elgen(fl_inp_model *r, fl_err *err);

#endif
