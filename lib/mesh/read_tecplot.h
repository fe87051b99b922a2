/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_tecplot.h -- zones of quadrilaterals and triangles of Tecplot (.tec, .dat). */
#ifndef FL_MESH_READ_TECPLOT_H
#define FL_MESH_READ_TECPLOT_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has lines that begin with VARIABLES and ZONE. */
int fl_tecplot_is(const fl_bytes *b);

/* Add the zones to s as one hull.  VARIABLES counts the columns, of which x y z are the first three.  ZONE
 * with N (NODES), E (ELEMENTS) and ET (ZONETYPE) of QUADRILATERAL or TRIANGLE is nodes and elements by
 * points; with I and J a grid of quadrilaterals.  Data by blocks are refused.
 * Source: Tecplot Data Format Guide, ASCII.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_tecplot_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
