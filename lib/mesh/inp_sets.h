/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_sets.h -- sets, surfaces and sections of an Abaqus deck. */
#ifndef FL_MESH_INP_SETS_H
#define FL_MESH_INP_SETS_H
#include "mesh/inp_model.h"

/* Data of the current keyword line:
 *     *ELSET     numbers, names of sets, "instance.12"; with GENERATE first, last, increment
 *     *SURFACE   an element or a set, and its face (S1 .. S6, SPOS, SNEG, or none for all free faces); with
 *                COMBINE=UNION names of surfaces.  Edges, nodes, differences and intersections are skipped,
 *                the first and the last two with a remark
 *     *BEAM SECTION and its like, *SOLID SECTION   the radius of round sections; for trusses that of a circle
 *                                                  of the same area
 * Names are resolved at the end of the deck.  0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_inp_elset(fl_inp_model *r, fl_err *err);
int fl_inp_surface(fl_inp_model *r, fl_err *err);
int fl_inp_read_section(fl_inp_model *r, fl_err *err);

/* Apply the section radii to the lines of the assembled mesh.  -1 with FL_INPUT (a set that contains itself)
 * or FL_SYSTEM. */
int fl_inp_apply_sections(fl_inp_model *r, fl_err *err);

#endif
