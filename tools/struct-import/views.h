/* SPDX-License-Identifier: GPL-3.0-or-later */
/* views.h -- three orthographic views of a structure, drawn by gnuplot. */
#ifndef STRUCT_IMPORT_VIEWS_H
#define STRUCT_IMPORT_VIEWS_H
#include "geom/surface.h"

/* Draw s from above, from the side and from the front.  where is a file that ends in .png or .svg, or a
 * folder (made if missing), which gets structure.png.  The file gets its name when it is complete.  0, or -1
 * with FL_SYSTEM in err (no gnuplot, disk full). */
int draw_views(const fl_surface *s, const char *where, fl_err *err);

#endif
