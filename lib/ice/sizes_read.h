/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes_read.h -- sizes of floes from a file: a list, a table, or the outlines of floes in an image. */
#ifndef FL_ICE_SIZES_READ_H
#define FL_ICE_SIZES_READ_H
#include "base/err.h"
#include "ice/sizes.h"

/* Read sizes.  The first row may say what the others hold; "-" is standard input, gzip is unpacked.
 *     area[m2]          one area a row (so too without such a row)
 *     d[m]              the diameter of the circle of equal area, D = sqrt(4 a / pi)
 *     area[m2] count    a table: the size, and how many, or which part, have it; also d[m] count
 *     x[m] y[m]         corners of polygons, in order, either way round, with a blank line or a row ">"
 *                       between two of them; the first corner may come again as the last.  The areas are
 *                       the sizes.
 * Returns 0, or -1 with FL_INPUT (a size that is no positive number or beyond 1e-12 .. 1e12, a polygon of
 * fewer than three corners or that crosses itself, no size at all) or FL_SYSTEM; out is untouched then. */
int fl_sizes_read(fl_sizes *out, const char *path, fl_err *err);

#endif
