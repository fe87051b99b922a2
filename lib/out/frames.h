/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frames.h -- ANIMATION_3D.DAT: shapes once, then poses frame by frame.  Format: animation(5). */
#ifndef FL_OUT_FRAMES_H
#define FL_OUT_FRAMES_H
#include "base/tool.h"
#include "geom/surface.h"
#include "out/poses.h"

/* Kind, history, then the shape of every body about its centre of mass, with the axes of the start,
 * shape ID RADIUS NV NF   v X Y Z ...   f N I1 ... IN ... and of the structure (NULL: none), the records of
 * g_struct. */
void fl_frames_header(FILE *f, const char *history, const fl_history_line *by, const fl_poses *s,
                      const fl_surface *surface);

/* The record of one body that has come in since. */
void fl_frames_shape(FILE *f, const fl_poses *s, int32_t i);

/* One frame:  frame T   body ID X Y Z QW QX QY QZ ...   structure X Y Z, the way the structure has gone.
 * ice = 0 leaves the bodies out. */
void fl_frames_frame(FILE *f, double t, const fl_poses *s, fl_vec3 gone, int ice);

/* And behind it, of a structure that does more than go one way:  moved ID X Y Z QW QX QY QZ, which takes a
 * vertex v of part ID to x + R(q) v. */
void fl_frames_part_pose(FILE *f, int32_t id, fl_vec3 x, fl_quat q);

#endif
