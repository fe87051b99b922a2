/* SPDX-License-Identifier: GPL-3.0-or-later */
/* prescribed_track.h -- a motion that is told: displacement and turn of a reference point against time.  Format:
 * track(5). */
#ifndef FL_STRUCTURE_PRESCRIBED_TRACK_H
#define FL_STRUCTURE_PRESCRIBED_TRACK_H
#include <stdint.h>
#include "base/err.h"
#include "geom/vec3.h"

/* Six numbers: x y z [m], then the rotation vector [rad]: a turn by |r| about r, world axes. */
typedef struct {
    fl_vec3 x, r;
} fl_pose6;

typedef struct {
    int32_t n;
    double *t;       /* [n] rising [s] */
    fl_pose6 *value; /* [n] */
    fl_pose6 *slope; /* [n] per second at the rows; NULL: straight between rows */
} fl_track;

/* Read a table of the kind track: a column t, and any of x y z [m] rx ry rz [deg]; one that is missing is 0.
 *   cubic  join the rows by the cubic spline whose velocity and acceleration are continuous; its slope at
 *          either end is that of the parabola through the three rows there, of two rows a straight line
 * -1 with FL_INPUT (no row, time that does not rise, a number that is none) or FL_SYSTEM; out is untouched
 * then.  Error of a cubic between rows that are h apart: order h^4 inside, h^3 at the ends.
 * Source: de Boor, A Practical Guide to Splines (1978), ch. 4. */
int fl_track_read(fl_track *out, const char *path, int cubic, fl_err *err);

/* Value, rate and second derivative at time t.  Before the first row and behind the last it goes on at the
 * rate that it has there; a single row is a rest.  At the rows of a straight track the rate is that behind.
 */
void fl_track_evaluate(const fl_track *tr, double t, fl_pose6 *x, fl_pose6 *rate, fl_pose6 *second);

/* Accepts a zeroed struct and leaves one. */
void fl_track_free(fl_track *tr);

#endif
