/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_stl.h -- the triangles of a surface as STL. */
#ifndef FL_MESH_WRITE_STL_H
#define FL_MESH_WRITE_STL_H
#include <stdio.h>
#include "geom/surface.h"

/* ASCII: each part is a solid with its name; coordinates have all digits.  Binary: all parts as one solid,
 * coordinates rounded to float32 (6e-8 relative).  Normals follow the winding, 0 0 0 for a triangle without
 * area.  Cones are not written: convert them to triangles first.  Write errors show in fl_out_close(). */
void fl_stl_write_ascii(FILE *f, const fl_surface *s);
void fl_stl_write_binary(FILE *f, const fl_surface *s);

#endif
