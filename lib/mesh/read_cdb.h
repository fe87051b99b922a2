/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_cdb.h -- ANSYS MAPDL archives: what CDWRITE writes (.cdb) and what Workbench hands to the solver
 * (ds.dat). */
#ifndef FL_MESH_READ_CDB_H
#define FL_MESH_READ_CDB_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* Has b a line with one of the commands NBLOCK and EBLOCK? */
int fl_cdb_is(const fl_bytes *b);

/* Add the surface of the archive to s.  Read are
 *   NBLOCK, EBLOCK, CMBLOCK, RLBLOCK, ETBLOCK   in the columns of their format line, so numbers may touch,
 *       rows may be short (what is missing is 0), and a number may have any exponent; EBLOCK with the key
 *       SOLID or without (then a row is: element, type, real, material, system, nodes)
 *   ET, KEYOPT, R, SECTYPE, SECDATA, TYPE, REAL, SECNUM, N, E, EN, EMORE, *SET and NAME=number
 * and all else is passed over.  The shape of an element is that of the routine of its type; one without a
 * surface of its own (contact, surface effect, spring, mass) or unknown is counted in a remark.  Solids and
 * shells collapse to what their repeated nodes leave.  A line has the outer radius of its section (PIPE, BEAM
 * of subtype CTUBE or CSOLID) or, as PIPE16, 20 and 59, of its real constants.
 * An element belongs to the part of the smallest component that it is in, or to one called name when it is in
 * none; each component of elements can be wished for as a set.
 *   b   its lines are cut in place
 *   w   NULL wishes for everything
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_cdb_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
