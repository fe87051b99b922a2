/* SPDX-License-Identifier: GPL-3.0-or-later */
/* state_io.h -- write or read the rows of a state, from one list of members.
 *
 * Every function writes a member to f if f is set, and reads it from `in` otherwise.  One list of calls
 * serves both ways, so that writer and reader cannot differ.  After the first failure, kept in err,
 * nothing is read. A double is written as the hexadecimal digits of its bits, without leading zeros. */
#ifndef FL_OUT_STATE_IO_H
#define FL_OUT_STATE_IO_H
#include <stdio.h>
#include "base/text.h"
#include "geom/quat.h"
#include "geom/vec3.h"

typedef struct {
    FILE *f;
    fl_text *in;
    fl_err *err;
} fl_state_io;

/* Begin a row with its name; end it. */
void fl_state_io_open(fl_state_io *t, const char *name);
void fl_state_io_close(fl_state_io *t);

/* A double other than NaN; an integer in [lo, hi]; a byte in [0, hi]; a count >= -1. */
void fl_state_io_real(fl_state_io *t, double *x);
void fl_state_io_int(fl_state_io *t, int32_t lo, int32_t hi, int32_t *x);
void fl_state_io_byte(fl_state_io *t, uint8_t hi, uint8_t *x);
void fl_state_io_count(fl_state_io *t, int64_t *x);

/* The components one by one. */
void fl_state_io_vec3(fl_state_io *t, fl_vec3 *x);
void fl_state_io_quat(fl_state_io *t, fl_quat *q);

/* A pose: a finite position and a unit quaternion. */
void fl_state_io_pose(fl_state_io *t, fl_vec3 *x, fl_quat *q);

/* The hash of data that is not stored but must be the same.  Returns 1 if another hash was read. */
int fl_state_io_hash(fl_state_io *t, uint64_t hash);

#endif
