/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_ply.h -- the triangles of a surface as PLY. */
#ifndef FL_MESH_WRITE_PLY_H
#define FL_MESH_WRITE_PLY_H
#include <stdio.h>
#include "geom/surface.h"

/* Binary, the lowest byte first, coordinates as doubles: nothing is rounded.  All parts one behind the other;
 * each face carries the id of its part as property "part" (int), and a comment "part ID NAME" a part tells
 * the names.  Cones are not written: give them facets first. Returns 0, or -1 with FL_INPUT when the vertices
 * are more than an int can number; write errors show in fl_out_close(). */
int fl_ply_write(FILE *f, const fl_surface *s, fl_err *err);

#endif
