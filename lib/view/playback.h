/* SPDX-License-Identifier: GPL-3.0-or-later */
/* playback.h -- the poses of a file of frames at any time, and values of bodies: speed, size and others.
 *
 * Between two frames places are linear in time and rotations normalised linear quaternions.  Speed and
 * spin are those of the file, state(5), else differences of these two frames.  A body that has jumped by
 * more than half of the scene, as across a periodic side, takes the pose of the nearer frame and has no
 * speed there. */
#ifndef FL_VIEW_PLAYBACK_H
#define FL_VIEW_PLAYBACK_H
#include "geom/aabb.h"
#include "out/frame_file.h"
#include "view/look.h"

typedef struct {
    fl_frame_file *file;       /* borrowed; NULL: one frame that does not move */
    const fl_frame_data *data; /* borrowed */
    fl_frame pair[2];          /* frames before and after the time */
    fl_frame now;              /* poses at the time; v and w: velocity and spin, NAN: unknown */
    fl_aabb box;               /* of a sample of frames */
    double *value;             /* [rows] of the last fl_playback_values(); NAN: none */
    int32_t value_cap;
} fl_playback;

/* file: borrowed; or data with `still`, the one frame to show, which the playback takes over.  -1 with
 * FL_INPUT or FL_SYSTEM. */
int fl_playback_open(fl_playback *p, fl_frame_file *file, const fl_frame_data *data, fl_frame *still,
                     fl_err *err);

/* First and last time [s]. */
double fl_playback_start(const fl_playback *p);
double fl_playback_end(const fl_playback *p);

/* Sets p->now.  Times beyond the ends are those of the ends.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_playback_at(fl_playback *p, double t, fl_err *err);

/* Sets p->value for speed, spin, diameter, thickness, height or number.  -1 with FL_SYSTEM. */
int fl_playback_values(fl_playback *p, int by, fl_err *err);

/* Extent of these values over a sample of frames: what 99.5 % stay below, rounded up to 1, 2 or 5 times a
 * power of ten; from 0, or from the least for heights and numbers.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_playback_range(fl_playback *p, int by, double *from, double *to, fl_err *err);

/* Size of a shape: diameter of a circle of its area seen from above, height with its radius [m]. */
double fl_shape_diameter(const fl_frame_data *d, const fl_frame_shape *s);
double fl_shape_thickness(const fl_frame_data *d, const fl_frame_shape *s);

/* x rounded up to 1, 2, 2.5 or 5 times a power of ten. */
double fl_round_up(double x);

/* What a value is, with its unit, as the legend says it. */
const char *fl_playback_legend(const fl_playback *p, int by);

void fl_playback_close(fl_playback *p); /* accepts a zeroed struct, leaves one */

#endif
