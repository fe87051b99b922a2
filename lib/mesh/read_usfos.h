/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_usfos.h -- models of USFOS in its own format (UFO). */
#ifndef FL_MESH_READ_USFOS_H
#define FL_MESH_READ_USFOS_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has a record NODE with a number and coordinates, and one of BEAM, QUADSHEL or TRISHELL. */
int fl_usfos_is(const fl_bytes *b);

/* Add the members and plates of the file to s, or its members to the frame of opt.
 *
 * A record is a keyword, of any case, and words behind it, also on lines that begin with a number; what
 * stands behind ' is comment.  Read are
 *   NODE id x y z [6 codes]                             codes hold a node of a frame
 *   BEAM id n1 n2 material geometry [lcoor [ecc1 ecc2]] 0: none
 *   PIPE id D T [shear shear [D at end 2]]
 *   BOX id H Tside Tbottom Ttop W                       H along the local z of UNITVEC
 *   IHPROFIL, GENBEAM                                   no outline; a frame takes their constants
 *   QUADSHEL id n1..n4 .., TRISHELL id n1..n3 ..
 *   ECCENT id ex ey ez                                  added to the end, in global axes
 *   UNITVEC, MISOIEP, MATERIAL id Elastic, NODEMASS; Name Group, GroupDef    an element belongs to the
 *   smallest of its groups
 * and all else is ignored.  Source: USFOS User's Manual, input description.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_usfos_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
