/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_file.h -- a file of frames: animation(5), text or packed, or state(5); one pass over it makes an
 * index, and a frame is read when it is asked for.
 *
 * Memory: the shapes, 64 bytes a frame, and one frame.  Read: plain, gzip, standard input ("-"); the files
 * NAME.0, NAME.1, ... of a run that splits its frames, given as NAME; NAME.part, the file of a run that
 * has not ended, where NAME is missing.  A file that is cut off ends at its last whole frame, with a
 * warning. */
#ifndef FL_OUT_FRAME_FILE_H
#define FL_OUT_FRAME_FILE_H
#include "out/frame_data.h"

typedef struct fl_frame_file fl_frame_file;

/* shapes: the ice file, g-polys(5), that a state file refers to; NULL: none.  NULL is returned with
 * FL_INPUT (missing, another kind, a record that is invalid: "file:line: ...") or FL_SYSTEM. */
fl_frame_file *fl_frame_file_open(const char *path, const char *shapes, fl_err *err);

/* True if the file can be one of frames, by its first line or its name. */
int fl_frame_file_is(const char *path);

/* Takes the parts of a structure, g_struct(5), where the file has none.  -1 with FL_INPUT or FL_SYSTEM. */
int fl_frame_file_add_structure(fl_frame_file *f, const char *path, fl_err *err);

const fl_frame_data *fl_frame_file_data(const fl_frame_file *f);
const char *fl_frame_file_name(const fl_frame_file *f);
const char *fl_frame_file_warning(const fl_frame_file *f); /* NULL: none */
const char *fl_frame_file_history(const fl_frame_file *f); /* the "#by" lines; NULL: none */

/* Frame k of the index, 0 <= k < frames.  0, or -1 with FL_INPUT or FL_SYSTEM; `out` then holds no frame. */
int fl_frame_file_read(fl_frame_file *f, int32_t k, fl_frame *out, fl_err *err);

/* Extends the index of a file that has grown.  Returns the number of new frames, or -1. */
int32_t fl_frame_file_extend(fl_frame_file *f, fl_err *err);

void fl_frame_file_close(fl_frame_file *f); /* NULL is accepted */

#endif
