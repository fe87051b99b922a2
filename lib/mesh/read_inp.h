/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_inp.h -- Abaqus and CalculiX decks: keyword lines that begin with *, data between commas. */
#ifndef FL_MESH_READ_INP_H
#define FL_MESH_READ_INP_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if the first line that is neither blank nor a comment (**) is a keyword, or if the first keyword
 * behind other text is one that decks begin with. */
int fl_inp_is(const fl_bytes *b);

/* Add the surface of the deck to s; b is emptied.  Flat decks and assemblies are read:
 *
 *     *NODE [SYSTEM=R|C, INPUT=]           id, x, y, z; missing ones are 0; in degrees where SYSTEM=C
 *     *SYSTEM                              moves the following nodes, until the next *SYSTEM
 *     *ELEMENT TYPE= [ELSET=, INPUT=]      types as in inp_type.h, others are counted
 *     *NGEN, *ELGEN                        nodes on a straight line; elements in rows, layers, blocks
 *     *ELSET [GENERATE, INSTANCE=]         numbers, ranges, names of sets
 *     *SURFACE [TYPE=ELEMENT, COMBINE=UNION]  faces S1 .. S6 of solids, sides SPOS and SNEG of shells
 *     *BEAM SECTION, *BEAM GENERAL SECTION, *FRAME SECTION  radius from SECTION=CIRC|PIPE|THICK PIPE
 *     *SOLID SECTION                       of trusses: radius of a circle of that area
 *     *PART, *INSTANCE, *ASSEMBLY          an instance is translated, then rotated; it may have its own mesh
 *     *INCLUDE INPUT=                      anywhere, relative to the deck
 *
 * The elements of one ELSET of *ELEMENT are a part, and so are those without; in an assembly it is called
 * "instance" or "instance.elset".  Sets and surfaces are "name" or "instance.name"; they are used if opt
 * selects them.  Other keywords that change the mesh are rejected by name (*NCOPY, *ELCOPY, *NFILL, *NMAP,
 * *PARAMETER ...); all others are ignored with their data.  At most FL_INP_GENERATED_MAX (inp_model.h) nodes
 * and elements may be generated.
 *   name   part of elements without a set in a flat deck
 *   opt    NULL selects everything
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM.
 * Source: Abaqus Keywords Reference Guide (2016); CalculiX CrunchiX User's Manual 2.20. */
int fl_inp_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
