/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_openfast.h -- input files of SubDyn and HydroDyn of OpenFAST, in their old and new layouts. */
#ifndef FL_MESH_READ_OPENFAST_H
#define FL_MESH_READ_OPENFAST_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if one of the first three lines names SubDyn or HydroDyn and a line has NJoints behind its value. */
int fl_openfast_is(const fl_bytes *b);

/* Add the members of the file to s, or to the frame of opt.
 *
 * A table begins with its count and name ("64 NJoints - ..."); two lines of column names and units and that
 * many rows follow.  Its columns are found by their names, so that both layouts are one.  Tables of the same
 * name are told apart by their columns:
 *   XsecD XsecT, PropD PropThck             circles: outer diameter and wall
 *   XsecSa XsecSb, XsecA XsecB, PropA PropB rectangles: side A is horizontal, of an upright member along x,
 *                                           both turned by MSpin degrees about the member
 *   XsecAsx ...                             constants of any section: no outline; a frame takes them
 * The diameter is linear from the first section to the second.  Words behind ! or # in a row of a section
 * name the part of its members, of a taper the first section does.  Cables, rigid links and springs are
 * counted. NReact holds joints of a frame, NCmass gives them masses.  Coordinates of HydroDyn move down by
 * MSL2SWL; marine growth is not added, and a remark says so.
 * Source: OpenFAST documentation, SubDyn and HydroDyn, input files.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_openfast_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
