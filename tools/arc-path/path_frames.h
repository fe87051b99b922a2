/* SPDX-License-Identifier: GPL-3.0-or-later */
/* path_frames.h -- the start and the points of a path as frames of ice-view(1): pieces are cylinders, the
 * time of a frame is the number of its point. */
#ifndef ARC_PATH_PATH_FRAMES_H
#define ARC_PATH_PATH_FRAMES_H
#include "options.h"
#include "base/stream.h"
#include "geom/surface.h"
#include "member/member_model.h"

struct path_frames {
    fl_out out;
    fl_surface surface; /* a part for each piece */
    int open;
};

/* Opens --frames and writes the shapes.  -1 with FL_SYSTEM. */
int path_frames_begin(struct path_frames *f, const struct options *o, const fl_member_model *m, fl_err *err);

/* The present shape of the chain. */
void path_frames_point(struct path_frames *f, const fl_member_chain *c, int64_t number);

/* Closes the file, or with keep = 0 leaves none.  -1 with FL_SYSTEM. */
int path_frames_end(struct path_frames *f, int keep, fl_err *err);

#endif
