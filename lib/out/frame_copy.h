/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_copy.h -- writes frames of a file again, as text or packed, animation(5). */
#ifndef FL_OUT_FRAME_COPY_H
#define FL_OUT_FRAME_COPY_H
#include <stdio.h>
#include "base/tool.h"
#include "out/frame_file.h"
#include "out/packed_frames.h"

typedef struct {
    double from, to;          /* frames of these times, both included [s] */
    int32_t every;            /* each every-th of them */
    fl_packed_writer *packed; /* NULL: text */
} fl_frame_copy;

/* Writes kind, history, shapes, parts and frames.  -1 with FL_INPUT (of the frames read) or FL_SYSTEM;
 * write errors stay in f, for fl_out_close(). */
int fl_frame_copy_write(FILE *f, fl_frame_file *file, const fl_frame_copy *how, const fl_history_line *by,
                        fl_err *err);

#endif
