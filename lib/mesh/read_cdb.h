/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_cdb.h -- ANSYS MAPDL archives, as written by CDWRITE (.cdb) and by Workbench for the solver (ds.dat).
 */
#ifndef FL_MESH_READ_CDB_H
#define FL_MESH_READ_CDB_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if a line of b is an NBLOCK or EBLOCK command and the next one a format like (3i9,6e21.13) or
 * numbers. */
int fl_cdb_is(const fl_bytes *b);

/* Add the surface of the archive to s.  Read are
 *   NBLOCK, EBLOCK, CMBLOCK, RLBLOCK, ETBLOCK   in the columns of their format line, so numbers may touch,
 *      rows may be short (missing numbers are 0), and a number may have any exponent; EBLOCK with the key
 *      SOLID or without (a row is then: element, type, real, material, system, nodes)
 *   ET, KEYOPT, R, SECTYPE, SECDATA, TYPE, REAL, SECNUM, N, E, EN, EMORE, *SET and NAME=number
 * and all else is ignored.  The routine of its type gives the shape of an element.  An element whose routine
 * is unknown or has no surface (contact, surface effect, spring, mass, fluid) is counted in a remark.  Solids
 * and shells with repeated nodes collapse to simpler shapes.  A line has the outer radius of its section
 * (PIPE, BEAM of subtype CTUBE or CSOLID) or, for PIPE16, 20 and 59, of its real constants.
 * An element belongs to the part of the smallest component that holds it, or to the part `name` if none does.
 * Each component of elements can be selected as a set.
 *   b     its lines are split in place
 *   opt   NULL selects everything
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_cdb_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
