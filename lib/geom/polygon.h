/* SPDX-License-Identifier: GPL-3.0-or-later */
/* polygon.h -- convex polygons in the plane, as corners and as sides.  Side k runs from v[k] to v[k + 1], the
 * last one back to v[0], counter-clockwise.  Offsets and cuts use the lines in side[]: a side knows its line
 * better than two nearly coincident corners do. */
#ifndef FL_GEOM_POLYGON_H
#define FL_GEOM_POLYGON_H
#include <stdint.h>

typedef struct {
    double x, y;
} fl_vec2;

/* The half-plane nx x + ny y <= c; (nx, ny) is the outward unit normal. */
typedef struct {
    double nx, ny, c;
    int32_t tag; /* for the caller; carried along */
} fl_polygon_side;

static inline double fl_polygon_side_distance(fl_polygon_side s, fl_vec2 p)
{
    return s.nx * p.x + s.ny * p.y - s.c;
}
/* Sine and cosine of the turning angle from side a to side b. */
static inline double fl_polygon_side_sin(fl_polygon_side a, fl_polygon_side b)
{
    return a.nx * b.ny - a.ny * b.nx;
}
static inline double fl_polygon_side_cos(fl_polygon_side a, fl_polygon_side b)
{
    return a.nx * b.nx + a.ny * b.ny;
}
/* Tangent of half the turning angle. */
static inline double fl_polygon_side_half_tan(fl_polygon_side a, fl_polygon_side b)
{
    return fl_polygon_side_sin(a, b) / (1.0 + fl_polygon_side_cos(a, b));
}

/* Intersection of the lines of a and b, both moved inward by d; fl_polygon_side_sin(a, b) != 0. */
fl_vec2 fl_polygon_side_intersect(fl_polygon_side a, fl_polygon_side b, double d);

/* Area (positive when counter-clockwise) and perimeter of v[n].  Products are taken from v[0], to keep
 * precision far from the origin. */
double fl_polygon_area(int32_t n, const fl_vec2 *v);
double fl_polygon_perimeter(int32_t n, const fl_vec2 *v);
double fl_polygon_side_length(int32_t n, const fl_vec2 *v, int32_t k); /* of side k */
fl_vec2 fl_polygon_centroid(int32_t n, const fl_vec2 *v);              /* area > 0 */

/* The rectangle lo .. hi: v[4], side[4] with tags -1 (left), -2 (bottom), -3 (right), -4 (top). */
void fl_polygon_rectangle(fl_vec2 lo, fl_vec2 hi, fl_vec2 *v, fl_polygon_side *side);

/* Clips by the half-plane h, in place; v and side have room for n + 1.
 * Returns the number of sides left, 0 if none. */
int32_t fl_polygon_cut(int32_t n, fl_vec2 *v, fl_polygon_side *side, fl_polygon_side h);

/* Corners of the polygon with its sides moved inward by d: v[k] is the intersection of side[k - 1] and
 * side[k].  Adjacent sides must turn left by less than pi. */
void fl_polygon_corners(int32_t n, const fl_polygon_side *side, double d, fl_vec2 *v);

/* Moves all sides inward by d >= 0 and drops those that vanish.  While the polygon shrinks by t, side k loses
 * t (tan(a/2) + tan(b/2)),  where a and b are the turning angles at its ends.  The side that first reaches
 * length zero is removed, its neighbours then meet, and so on (the straight skeleton of a convex polygon).
 *   v      in: corners at t = 0.  out: corners at t = d, of the sides left
 *   side   in and out; c stays that of t = 0
 *   depth  out: d, or the radius of the largest inscribed circle if that is smaller
 * Returns the number of sides left, 0 if the polygon has vanished. */
int32_t fl_polygon_inset(int32_t n, fl_vec2 *v, fl_polygon_side *side, double d, double *depth);

/* Corners of the polygon v[n] with its sides moved outward by r >= 0; corners stay sharp. */
void fl_polygon_outset(int32_t n, const fl_vec2 *v, double r, fl_vec2 *out);

/* Distance of p from the filled polygon v[n], 0 inside. */
double fl_polygon_point_distance(int32_t n, const fl_vec2 *v, fl_vec2 p);

/* 1 if a side of one polygon has all of the other strictly beyond it, within the rounding of one product:
 * convex polygons that neither overlap nor touch (separating axis). */
int fl_polygon_is_apart(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b);

/* Distance between two polygons without a point inside each other: the least from a corner of one to a side
 * of the other.  O(m n). */
double fl_polygon_distance(int32_t m, const fl_vec2 *a, int32_t n, const fl_vec2 *b);

#endif
