/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_obj.h -- the triangles of a surface as Wavefront OBJ. */
#ifndef FL_MESH_WRITE_OBJ_H
#define FL_MESH_WRITE_OBJ_H
#include <stdio.h>
#include "geom/surface.h"

/* Each part is an object (o) with its name.  Vertices have all digits and are numbered from 1 through all
 * parts.  Cones are not written: convert them to triangles first.  Write errors show in fl_out_close(). */
void fl_obj_write(FILE *f, const fl_surface *s);

#endif
