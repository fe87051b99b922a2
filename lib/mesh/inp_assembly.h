/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_assembly.h -- parts and instances of an Abaqus deck. */
#ifndef FL_MESH_INP_ASSEMBLY_H
#define FL_MESH_INP_ASSEMBLY_H
#include "mesh/inp_model.h"

/* Keyword lines that open or close a part or an instance:
 *     *PART, *END PART           nodes and elements with numbers of their own, placed by an instance
 *     *ASSEMBLY                  no effect of its own
 *     *INSTANCE, *END INSTANCE   an instance of a part, or of a mesh of its own: the first data line
 *                                translates it, the second then rotates it about an axis by degrees
 * 0, or -1 with FL_INPUT (wrong nesting, a name that exists already or does not exist, an axis without
 * length) or FL_SYSTEM. */
int fl_inp_begin_part(fl_inp_model *r, fl_err *err);
int fl_inp_end_part(fl_inp_model *r, fl_err *err);
int fl_inp_assembly(fl_inp_model *r, fl_err *err);
int fl_inp_instance(fl_inp_model *r, fl_err *err);
int fl_inp_end_instance(fl_inp_model *r, fl_err *err);

/* Handle parts without an instance, at the end of the deck: a deck without any instance places all parts
 * where they are defined; otherwise such parts are skipped, with a remark.  -1 with FL_SYSTEM. */
int fl_inp_place_unused_parts(fl_inp_model *r, fl_err *err);

#endif
