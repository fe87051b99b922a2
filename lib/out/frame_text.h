/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_text.h -- records of animation(5), version 1: the first pass over them, and the poses of one
 * frame. */
#ifndef FL_OUT_FRAME_TEXT_H
#define FL_OUT_FRAME_TEXT_H
#include "out/frame_data.h"

/* Largest coordinate and radius [m]. */
#define FL_FRAME_MAX_COORD 1e9

/* State of the first pass. */
typedef struct {
    fl_frame_data *d; /* borrowed */
    const char *name; /* of the file, borrowed */
    int64_t line;     /* number of the last line */
    int32_t piece;
    int32_t vertices_due, faces_due; /* of the shape under way */
    int in_shape, in_part, in_frame, known_part;
    int packed;              /* a line "packed" has ended the text */
    double bound_x, bound_q; /* of it [m], [rad] */
    int32_t key_every;
} fl_frame_text;

/* One line [at, end), which *end == '\n' closes; offset: place of `at` in the file.  0, or -1 with FL_INPUT
 * ("file:line: ...") or FL_SYSTEM. */
int fl_frame_text_line(fl_frame_text *s, const char *at, const char *end, int64_t offset, fl_err *err);

/* The end of a file, or of a block of records: a shape must be complete.  `offset`: its length. */
int fl_frame_text_end(fl_frame_text *s, int64_t offset, fl_err *err);

/* The records of frame e, its bytes given and closed by a newline: poses of bodies, and of the parts.
 *   bodies, parts   0: records of that kind are not read
 * `out` has been cleared.  0, or -1 with FL_INPUT: a body without a shape, or twice; a pose that is not
 * finite; a quaternion that is no rotation. */
int fl_frame_text_read(const fl_frame_data *d, const fl_frame_entry *e, const char *name, const char *bytes,
                       int bodies, int parts, fl_frame *out, fl_err *err);

/* Sets a pose after the checks of the above; `line` 0: none. */
int fl_frame_set_pose(const fl_frame_data *d, const char *name, int64_t line, int32_t row, fl_vec3 x,
                      fl_quat q, fl_frame *out, fl_err *err);

/* Moves a part, or with id -1 all of them. */
int fl_frame_set_part(const fl_frame_data *d, const char *name, int64_t line, int32_t id, fl_vec3 x,
                      fl_quat q, fl_frame *out, fl_err *err);

#endif
