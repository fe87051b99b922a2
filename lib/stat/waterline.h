/* SPDX-License-Identifier: GPL-3.0-or-later */
/* waterline.h -- arc length along the waterline of a structure.
 *
 * The waterline is a curve in plan, a circle or a polyline, with arc length s from 0 to its length.  A circle
 * runs counter-clockwise from +x as seen from above.  A polyline runs from its first point to its last and is
 * closed where they coincide. */
#ifndef FL_STAT_WATERLINE_H
#define FL_STAT_WATERLINE_H
#include <stdint.h>
#include "base/err.h"

enum { FL_WATERLINE_MAX = 1000 };

typedef struct {
    int circle;
    double x0, y0, r;                                                     /* of a circle [m] */
    int32_t n;                                                            /* points of a polyline */
    double x[FL_WATERLINE_MAX], y[FL_WATERLINE_MAX], s[FL_WATERLINE_MAX]; /* and their arc length [m] */
    double length;                                                        /* total [m] */
} fl_waterline;

/* "circle:X,Y,R", or "X,Y:X,Y:..." of 2 .. FL_WATERLINE_MAX points, no two neighbours equal.
 * 0, or -1 with FL_USAGE in err. */
int fl_waterline_make(fl_waterline *w, const char *text, fl_err *err);

/* s of the point of the waterline nearest to (x, y) in plan, the first of several: 0 <= s <= length.  The
 * centre of a circle has s = 0. */
double fl_waterline_nearest(const fl_waterline *w, double x, double y);

/* The point at s, 0 <= s <= length. */
void fl_waterline_point(const fl_waterline *w, double s, double *x, double *y);

#endif
