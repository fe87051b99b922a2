/* SPDX-License-Identifier: GPL-3.0-or-later */
/* read_nemoh.h -- panels of NEMOH (.dat, .mar). */
#ifndef FL_MESH_READ_NEMOH_H
#define FL_MESH_READ_NEMOH_H
#include "geom/surface.h"
#include "mesh/bytes.h"
#include "mesh/import_options.h"

/* True if line 1 of b is "2" and 0 or 1, or four integers with a node behind them. */
int fl_nemoh_is(const fl_bytes *b);

/* Add the hull to s.  The file is
 *   2 s; rows "id x y z" up to id 0; rows of four nodes up to zeros
 * where s = 1 mirrors in y = 0.  A mesh of a free surface, whose line 1 has four integers, is refused.
 * Source: NEMOH, documentation of the mesh file.
 * Returns 0, or -1 with FL_INPUT or FL_SYSTEM in err; s may then have new parts. */
int fl_nemoh_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err);

#endif
