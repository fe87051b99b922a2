/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_sets.h -- sets, surfaces and sections of an Abaqus deck: what is said of elements by name. */
#ifndef FL_MESH_INP_SETS_H
#define FL_MESH_INP_SETS_H
#include "mesh/inp_model.h"

/* What stands behind the keyword line at hand:
 *     *ELSET     numbers, names of sets, "instance.12"; with GENERATE first, last, step
 *     *SURFACE   an element or a set, and the face of it (S1 .. S6, SPOS, SNEG, or none for all that are
 *                free); with COMBINE=UNION names of surfaces.  Edges, nodes, differences and intersections
 *                are passed over, the first and the last two with a remark
 *     *BEAM SECTION and its like, *SOLID SECTION   the radius of round ones; that of the area for trusses
 * Names are looked up when all is read.  0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_inp_elset(fl_inp_model *r, fl_err *err);
int fl_inp_surface(fl_inp_model *r, fl_err *err);
int fl_inp_read_section(fl_inp_model *r, fl_err *err);

/* Give the lines of the deck, once they are in their places, the radii of their sections.  -1 with FL_INPUT
 * (a set that contains itself) or FL_SYSTEM. */
int fl_inp_apply_sections(fl_inp_model *r, fl_err *err);

#endif
