/* SPDX-License-Identifier: GPL-3.0-or-later */
/* views.h -- three views of a structure, drawn by gnuplot. */
#ifndef STRUCT_IMPORT_VIEWS_H
#define STRUCT_IMPORT_VIEWS_H
#include "geom/surface.h"

/* Draw s from above, from the side and from the front into a file: where is one that ends in .png or .svg, or
 * a folder (made when missing), which gets structure.png.  The file has its name when it is complete.
 * 0, or -1 with FL_SYSTEM in err (no gnuplot, no room). */
int views(const fl_surface *s, const char *where, fl_err *err);

#endif
