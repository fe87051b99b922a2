/* SPDX-License-Identifier: GPL-3.0-or-later */
/* write_off.h -- the triangles of a surface as OFF. */
#ifndef FL_MESH_WRITE_OFF_H
#define FL_MESH_WRITE_OFF_H
#include <stdio.h>
#include "geom/surface.h"

/* All parts follow one another in one mesh: OFF has neither parts nor names.  Vertices have all digits.
 * Cones are not written: convert them to triangles first.  Write errors show in fl_out_close(). */
void fl_off_write(FILE *f, const fl_surface *s);

#endif
