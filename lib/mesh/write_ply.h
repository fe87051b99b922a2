/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_ply.h -- the triangles of a surface as PLY. */
#ifndef FL_MESH_WRITE_PLY_H
#define FL_MESH_WRITE_PLY_H
#include <stdio.h>
#include "geom/surface.h"

/* Binary, little-endian, coordinates as doubles: nothing is rounded.  All parts follow one another.  Each
 * face has the id of its part as property "part" (int); a comment "part ID NAME" gives the name of each part.
 * Cones are not written: convert them to triangles first.  Returns 0, or -1 with FL_INPUT if there are more
 * vertices than an int can number; write errors show in fl_out_close(). */
int fl_ply_write(FILE *f, const fl_surface *s, fl_err *err);

#endif
