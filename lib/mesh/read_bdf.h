/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_bdf.h -- Nastran bulk data: entries of fields, in columns of 8 or 16 or between commas. */
#ifndef FL_MESH_READ_BDF_H
#define FL_MESH_READ_BDF_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if a line begins with GRID, BEGIN BULK or INCLUDE '...', and no line before it begins with a character
 * that Nastran does not allow there. */
int fl_bdf_is(const fl_bytes *b);

/* Add the surface of the deck to s; b is emptied.  Small, large and free field may be mixed from line to
 * line.  A line that begins with +, * or a blank field continues an entry; $ opens a comment; case does not
 * matter.
 *
 *     GRID, GRDSET                      in any coordinate system, defined before or after
 *     CORD1R C S, CORD2R C S            by three grids; by three points in another system; angles in degrees
 *     CTRIA3 CTRIAR CTRIA6 CPLSTN3 CPLSTS3     CQUAD4 CQUADR CQUAD8 CQUAD CSHEAR CPLSTN4 CPLSTS4
 *     CTETRA CPYRAM CPENTA CHEXA        of 4, 5, 6, 8 nodes or 10, 13, 15, 20
 *     CBAR CBEAM CROD CTUBE CONROD      with the radius of PTUBE, PBARL and PBEAML (ROD, TUBE, TUBE2), or
 *                                       that of a circle of the area of PROD and CONROD.  PBAR, PBEAM and
 *                                       other sections give none: skipped with a remark
 *     INCLUDE, BEGIN BULK, ENDDATA      BEGIN BULK may be absent; nothing behind ENDDATA is read.  Before
 *                                       BEGIN BULK a file that cannot be included is skipped, with a remark
 *
 * Other elements are counted, and so are fluids (PSOLID with PFLUID); other entries are ignored.  Models of
 * their own (BEGIN [BULK] SUPER, AUXMODEL, ARBMODEL, MODULE), replication (=) and undefined references are
 * rejected.  Each property is a part, called "property_7" or by the name that HyperMesh ($HMNAME PROP),
 * ANSA ($ANSA_NAME_COMMENT) or Femap ($ Femap Property) leaves in a comment; CONROD elements are the part
 * "conrod".
 *   name   not used: every element has a property or is a CONROD
 *   opt    NULL selects everything
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM.  Source: MSC Nastran Quick Reference Guide (2012). */
int fl_bdf_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
