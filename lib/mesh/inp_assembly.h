/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_assembly.h -- parts of an Abaqus deck, and where their instances stand. */
#ifndef FL_MESH_INP_ASSEMBLY_H
#define FL_MESH_INP_ASSEMBLY_H
#include "mesh/inp_model.h"

/* What the keyword line at hand opens or closes:
 *     *PART, *END PART           nodes and elements of their own numbering, which wait for an instance
 *     *ASSEMBLY                  nothing more than what is in it
 *     *INSTANCE, *END INSTANCE   a part (or a mesh of its own) in its place: the first line moves it, the
 *                                second one then turns it about an axis by degrees
 * 0, or -1 with FL_INPUT (one inside another, a name that comes twice or is not there, an axis without
 * length) or FL_SYSTEM. */
int fl_inp_begin_part(fl_inp_model *r, fl_err *err);
int fl_inp_end_part(fl_inp_model *r, fl_err *err);
int fl_inp_assembly(fl_inp_model *r, fl_err *err);
int fl_inp_instance(fl_inp_model *r, fl_err *err);
int fl_inp_end_instance(fl_inp_model *r, fl_err *err);

/* Parts that nobody placed, when all is read: they stand where they are defined when there is no instance at
 * all, and are passed over when there is; a remark says so.  -1 with FL_SYSTEM. */
int fl_inp_place_unused_parts(fl_inp_model *r, fl_err *err);

#endif
