/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_state.h -- the rows of a state table, state(5), as frames: those of one time are one frame. */
#ifndef FL_OUT_FRAME_STATE_H
#define FL_OUT_FRAME_STATE_H
#include "out/frame_data.h"

enum { FL_FRAME_STATE_COLUMNS = 15 };

/* State of the first pass. */
typedef struct {
    fl_frame_data *d; /* borrowed */
    const char *name; /* borrowed */
    int64_t line;
    int in_rows;   /* the column names have passed */
    char time[64]; /* of the last row, as it stands */
} fl_frame_state;

/* One line [at, end) that *end == '\n' closes.  0, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_frame_state_line(fl_frame_state *s, const char *at, const char *end, int64_t offset, fl_err *err);
void fl_frame_state_end(fl_frame_state *s, int64_t offset);

/* Called for each row. */
typedef int fl_frame_state_row(void *to, int64_t line, int32_t id, fl_vec3 x, fl_quat q, fl_vec3 v, fl_vec3 w,
                               fl_err *err);

/* The rows of frame e, its bytes given.  0, or -1 with FL_INPUT or what `row` returned. */
int fl_frame_state_read(const fl_frame_entry *e, const char *name, const char *bytes, fl_frame_state_row *row,
                        void *to, fl_err *err);

#endif
