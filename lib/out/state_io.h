/* SPDX-License-Identifier: GPL-3.0-or-later */
/* state_io.h -- rows of a state on their way out or in: one list of members serves both, so that they cannot
 * differ.
 *
 * Every function writes a member to f where that is set, and reads it from `in` otherwise; after the first
 * failure, which is in err, nothing is read.  Doubles are the hexadecimal digits of their bits, leading zeros
 * left out. */
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

/* A row begins with its name, and ends. */
void fl_state_io_open(fl_state_io *t, const char *name);
void fl_state_io_close(fl_state_io *t);

/* A double that is a number; a whole number within bounds; a byte from 0 to hi; a count from -1 on. */
void fl_state_io_real(fl_state_io *t, double *x);
void fl_state_io_int(fl_state_io *t, int32_t lo, int32_t hi, int32_t *x);
void fl_state_io_byte(fl_state_io *t, uint8_t hi, uint8_t *x);
void fl_state_io_count(fl_state_io *t, int64_t *x);

/* Numbers in a row. */
void fl_state_io_vec3(fl_state_io *t, fl_vec3 *x);
void fl_state_io_quat(fl_state_io *t, fl_quat *q);

/* Where something stands: finite, and turned by a unit quaternion. */
void fl_state_io_pose(fl_state_io *t, fl_vec3 *x, fl_quat *q);

/* The hash of what is not kept but must be the same: 1 where another one was read. */
int fl_state_io_hash(fl_state_io *t, uint64_t hash);

#endif
