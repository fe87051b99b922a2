/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_gdf.h -- panels of WAMIT (.gdf), flat ones. */
#ifndef FL_MESH_READ_GDF_H
#define FL_MESH_READ_GDF_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if line 2 of b begins with two numbers, line 3 with two integers from -1 to 1 and line 4 with one
 * above 0.  The format has no word of its own: ask last. */
int fl_gdf_is(const fl_bytes *b);

/* Add the hull to s.  The file is
 *   title; ULEN GRAV; ISX ISY; NPAN [IGDEF]; 12 NPAN numbers, four corners of each panel, any number a line
 * with text behind the counts.  ULEN scales nothing.  ISX 1 mirrors in x = 0, ISY 1 in y = 0; -1 is a wall
 * and mirrors nothing, which a remark says.  Dipole panels behind them are counted.  GRAV of 32 or 9810
 * speaks of feet or millimetres: a remark, nothing is scaled.  IGDEF other than 0 (patches of higher order)
 * and a negative ULEN (a list of bodies) are refused.
 * Source: WAMIT User Manual, chapters 6 and 7.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_gdf_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
