/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_bdf.h -- bulk data of Nastran: entries of fields, in columns of 8 or 16 or between commas. */
#ifndef FL_MESH_READ_BDF_H
#define FL_MESH_READ_BDF_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Has it a line that begins with GRID, BEGIN BULK or INCLUDE '...', before which no line begins as none of
 * Nastran's does? */
int fl_bdf_is(const fl_bytes *b);

/* Add the parts of a deck to s; b is emptied.  Small, large and free field mix freely, from line to line; an
 * entry goes on in lines that begin with +, * or a blank field; $ opens a comment; letters of either case are
 * equal.
 *
 *     GRID, GRDSET                      in any coordinate system, given before or after
 *     CORD1R C S, CORD2R C S            by three grids; by three points in another system; angles in degrees
 *     CTRIA3 CTRIAR CTRIA6 CPLSTN3 CPLSTS3     CQUAD4 CQUADR CQUAD8 CQUAD CSHEAR CPLSTN4 CPLSTS4
 *     CTETRA CPYRAM CPENTA CHEXA        of 4, 5, 6, 8 nodes or 10, 13, 15, 20
 *     CBAR CBEAM CROD CTUBE CONROD      with the radius that PTUBE, PBARL and PBEAML (ROD, TUBE, TUBE2), or
 *                                       the area of PROD and CONROD, give
 *     INCLUDE, BEGIN BULK, ENDDATA      BEGIN BULK may be absent; nothing behind ENDDATA is read
 *
 * Other elements are counted and passed over, other entries passed over.  BEGIN SUPER, replication (=) and
 * entries that nothing defines are refused.  A part is what one property holds, called "property_7", or by
 * the name that HyperMesh ($HMNAME PROP), ANSA ($ANSA_NAME_COMMENT) or Femap ($ Femap Property) leave in a
 * comment; "conrod" is that of CONROD. Returns 0, or -1 with FL_INPUT or FL_SYSTEM.  Source: MSC Nastran
 * Quick Reference Guide (2012). */
int fl_bdf_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
