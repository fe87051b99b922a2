/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frames.h -- ANIMATION_3D.DAT: shapes once, then the poses of each frame.  Format: animation(5). */
#ifndef FL_OUT_FRAMES_H
#define FL_OUT_FRAMES_H
#include "base/tool.h"
#include "geom/surface.h"
#include "out/packed_frames.h"
#include "out/poses.h"

/* Write kind and history; then the shape of every body about its centre of mass, with the axes of the start,
 *     shape ID RADIUS NV NF   v X Y Z ...   f N I1 ... IN ...
 * and the structure (NULL: none) in the records of g_struct(5).  packed: NULL, or frames follow as blocks. */
void fl_frames_header(FILE *f, const char *history, const fl_history_line *by, const fl_poses *s,
                      const fl_surface *surface, const fl_packed_writer *packed);

/* Write the shape record of body i, which came in after the header. */
void fl_frames_shape(FILE *f, const fl_poses *s, int32_t i);

/* Write one frame:
 *     frame T   body ID X Y Z QW QX QY QZ ...   structure X Y Z
 * displacement: of a structure that only translates; 0 writes no record.  ice = 0 leaves out the bodies. */
void fl_frames_frame(FILE *f, double t, const fl_poses *s, fl_vec3 displacement, int ice);

/* Write the pose of a part that does more than translate with the whole structure:
 *     moved ID X Y Z QW QX QY QZ       vertex v of part ID is now at x + R(q) v. */
void fl_frames_part_pose(FILE *f, int32_t id, fl_vec3 x, fl_quat q);

/* The same frame packed: bodies of s into w, after fl_packed_frame_clear(); parts and the frame itself are
 * the caller's.  -1 with FL_SYSTEM. */
int fl_frames_packed_bodies(fl_packed_writer *w, const fl_poses *s, fl_err *err);

#endif
