/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_stl.h -- the triangles of a surface as STL. */
#ifndef FL_MESH_WRITE_STL_H
#define FL_MESH_WRITE_STL_H
#include <stdio.h>
#include "geom/surface.h"

/* ASCII: a solid a part, under its name, and all digits of each coordinate.  Binary: all parts as one,
 * coordinates rounded to float32 (6e-8 of their size).  Normals are those of the winding, 0 0 0 for a
 * triangle without area. Cones are not written: give them facets first.  Write errors show in fl_out_close().
 * */
void fl_stl_write_ascii(FILE *f, const fl_surface *s);
void fl_stl_write_binary(FILE *f, const fl_surface *s);

#endif
