/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_inp.h -- decks of Abaqus and CalculiX: keyword lines that begin with *, data between commas. */
#ifndef FL_MESH_READ_INP_H
#define FL_MESH_READ_INP_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Is the first line that is neither blank nor a comment (**) a keyword, or the first keyword behind other
 * text one that decks begin with? */
int fl_inp_is(const fl_bytes *b);

/* Add the parts of a deck to s; b is emptied.  Flat decks and assemblies are read alike:
 *
 *     *NODE [SYSTEM=R|C, INPUT=]           id, x, y, z; what is missing is 0; in degrees where SYSTEM=C
 *     *SYSTEM                              moves the nodes that follow, until the next one
 *     *ELEMENT TYPE= [ELSET=, INPUT=]      types as in inp_type.h, others are counted and passed over
 *     *NGEN, *ELGEN                        nodes on a straight line; elements in rows, layers, blocks
 *     *ELSET [GENERATE, INSTANCE=]         numbers, ranges, names of sets
 *     *SURFACE [TYPE=ELEMENT, COMBINE=UNION]  faces S1 .. S6 of solids, sides SPOS and SNEG of shells
 *     *BEAM SECTION, *BEAM GENERAL SECTION, *FRAME SECTION  SECTION=CIRC|PIPE|THICK PIPE give the radius
 *     *SOLID SECTION                       of trusses: the circle of that area
 *     *PART, *INSTANCE, *ASSEMBLY          an instance is moved, then turned, and may have a mesh of its own
 *     *INCLUDE INPUT=                      anywhere, relative to the deck
 *
 * A part of the surface is what one ELSET of *ELEMENT holds, or what has none; in an assembly it is called
 * "instance" or "instance.elset".  Sets and surfaces are "name" or "instance.name" and are taken when w
 * chooses them.  What else changes the mesh is refused by name (*NCOPY, *ELCOPY, *NFILL, *NMAP, *PARAMETER
 * ...); other keywords are passed over with their data.  At most FL_INP_GENERATED_MAX (inp_model.h) nodes
 * and elements may be generated.
 *   name   of elements without a set in a flat deck
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM.
 * Source: Abaqus Keywords Reference Guide (2016); CalculiX CrunchiX User's Manual 2.20. */
int fl_inp_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
