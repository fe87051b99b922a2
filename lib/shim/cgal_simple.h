/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cgal_simple.h -- exact test whether a polygon is simple. */
#ifndef FL_SHIM_CGAL_SIMPLE_H
#define FL_SHIM_CGAL_SIMPLE_H
#include <stdint.h>
#include "base/err.h"
#include "geom/polygon.h"

#ifdef __cplusplus
extern "C" {
#endif

/* 1 if no two sides of the closed polygon v[n], n >= 3, meet except neighbours in their common corner; 0 if
 * some do or a corner appears twice; -1 with FL_SYSTEM or FL_NUMERIC.  Either orientation.  O(n log n).
 * Source: Shamos & Hoey, FOCS (1976) 208; CGAL, 2D Polygons, is_simple_2. */
int fl_cgal_is_simple(int32_t n, const fl_vec2 *v, fl_err *err);

#ifdef __cplusplus
}
#endif
#endif
