/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sizes_read.h -- sizes of floes from a file: a list, a table, or outlines of floes from an image. */
#ifndef FL_ICE_SIZES_READ_H
#define FL_ICE_SIZES_READ_H
#include "base/err.h"
#include "ice/sizes.h"

/* Read sizes.  The first row may name the columns; "-" is standard input, gzip is unpacked.
 *    area[m2]          one area a row (also without such a row)
 *    d[m]              diameter of the circle of equal area, D = sqrt(4 a / pi)
 *    area[m2] count    a table of sizes and their counts or fractions; also d[m] count
 *    x[m] y[m]         corners of polygons, in order, of either orientation, with a blank line or a row ">"
 *                      between two polygons; the last corner may repeat the first.  The sizes are the areas.
 * Returns 0, or -1 with FL_INPUT (a size that is no positive number or beyond 1e-12 .. 1e12, a polygon
 * with fewer than three corners or that crosses itself, no size at all) or FL_SYSTEM; out is unchanged
 * then. */
int fl_sizes_read(fl_sizes *out, const char *path, fl_err *err);

#endif
