/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_elements.h -- the elements of an Abaqus deck. */
#ifndef FL_MESH_INP_ELEMENTS_H
#define FL_MESH_INP_ELEMENTS_H
#include "mesh/inp_model.h"

/* What stands behind the keyword line at hand:
 *     *ELEMENT   number and nodes, over as many lines as they take.  The set of ELSET= is the part; elements
 *                of a type without a surface are counted
 *     *ELGEN     the element to begin with; then how many in a row, and the steps of nodes and numbers; the
 *                same for rows, and for layers of these
 * 0, or -1 with FL_INPUT (too few or too many nodes, an element that is not there) or FL_SYSTEM. */
int fl_inp_element(fl_inp_model *r, fl_err *err);
int fl_inp_elgen(fl_inp_model *r, fl_err *err);

#endif
