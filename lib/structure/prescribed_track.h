/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prescribed_track.h -- prescribed motion: displacement and rotation of a reference point over time. Format:
 * track(5). */
#ifndef FL_STRUCTURE_PRESCRIBED_TRACK_H
#define FL_STRUCTURE_PRESCRIBED_TRACK_H
#include <stdint.h>
#include "base/err.h"
#include "geom/vec3.h"

/* x y z [m], then the rotation vector [rad]: a rotation by |r| about r, world axes. */
typedef struct {
    fl_vec3 x, r;
} fl_pose6;

typedef struct {
    int32_t n;
    double *t;       /* [n] ascending [s] */
    fl_pose6 *value; /* [n] */
    fl_pose6 *slope; /* [n] rates at the rows; NULL: linear between rows */
} fl_track;

/* Reads a table of the kind track: a column t, and any of x y z [m] rx ry rz [deg]; a missing column is 0.
 *   cubic  interpolate by the cubic spline with continuous velocity and acceleration; the slope at
 *          either end is that of the parabola through the three rows there, for two rows a straight line
 * Returns -1 with FL_INPUT (no row, time that does not rise, a cell that is no number) or FL_SYSTEM, and out
 * untouched. The error of a cubic between rows h apart is of order h^4 inside, h^3 at the ends. Source: de
 * Boor, A Practical Guide to Splines (1978), ch. 4. */
int fl_track_read(fl_track *out, const char *path, int cubic, fl_err *err);

/* Value, rate and second derivative at time t. Before the first and after the last row the motion continues
 * at the rate there; a single row is a state of rest. At a row of a linear track the rate is that after it.
 */
void fl_track_evaluate(const fl_track *tr, double t, fl_pose6 *x, fl_pose6 *rate, fl_pose6 *second);

/* Accepts a zeroed struct and leaves one. */
void fl_track_free(fl_track *tr);

#endif
