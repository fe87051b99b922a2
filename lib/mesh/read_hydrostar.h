/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_hydrostar.h -- panels of HydroStar (.hst). */
#ifndef FL_MESH_READ_HYDROSTAR_H
#define FL_MESH_READ_HYDROSTAR_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if b has lines that begin with COORDINATES and PANEL. */
int fl_hydrostar_is(const fl_bytes *b);

/* Add the bodies to s.  COORDINATES to ENDCOORDINATES are rows "id x y z", or "x y z" counted from 1; PANEL
 * TYPE 0 to ENDPANEL rows of nodes, TYPE 1 of a number and nodes.  Blocks may repeat.  NUMPANEL b i j gives
 * panels i to j to body b.  SYMMETRY_BODY b k and SYMMETRY k: 1 mirrors in y = 0, 2 in x = 0 too.
 * Source: HydroStar User's Manual, mesh file; BEMRosetta, Capytaine.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_hydrostar_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
