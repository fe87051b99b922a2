/* SPDX-License-Identifier: GPL-3.0-or-later */
/* plan_polygon.h -- the outline of a floe in its own plane, for its statics: moments of parts that a line
 * cuts off, and the loads on it. */
#ifndef FL_FAILURE_PLAN_POLYGON_H
#define FL_FAILURE_PLAN_POLYGON_H
#include "geom/poly.h"
#include "geom/polygon.h"

/* Plan axes: x and y in the plane of the floe, z along its thickness, the origin at its centre of mass. */
enum { FL_PLAN_CORNERS = 64 };
typedef struct {
    int32_t n; /* corners, counter-clockwise; 0: none */
    fl_vec2 p[FL_PLAN_CORNERS];
    double thickness; /* h [m] */
    double bottom;    /* z of the lower face [m] */
} fl_plan;

/* Integrals over a part of the plan. */
typedef struct {
    double area, x, y; /* int dA, int x dA, int y dA */
    double xx, xy, yy; /* int x x dA, ... */
} fl_plan_moments;

/* A contact load on a floe, in plan axes. */
typedef struct {
    fl_vec3 x, force; /* where [m], what [N] */
    double width;     /* of the contact along the rim [m] */
} fl_plan_load;

/* Outline and thickness of a sharp solid p whose thickness is along the unit vector `up`; x, y: the axes of
 * the plan, in the frame of p.  Of a shape that is no upright prism the outline is that of its projection.
 * n = 0 if it has more than FL_PLAN_CORNERS corners or no volume. */
void fl_plan_of(fl_plan *q, const fl_poly *p, fl_vec3 x, fl_vec3 y, fl_vec3 up);

/* Moments of the part e.x <= c, e of unit length; c = INFINITY: of all. */
fl_plan_moments fl_plan_part(const fl_plan *q, double ex, double ey, double c);

/* Length of the section e.x = c, 0 beside the plan [m]; *middle: its middle. */
double fl_plan_width(const fl_plan *q, double ex, double ey, double c, fl_vec2 *middle);

/* Least and largest e.x of the plan. */
void fl_plan_extent(const fl_plan *q, double ex, double ey, double *from, double *to);

#endif
