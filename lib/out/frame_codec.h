/* SPDX-License-Identifier: GPL-3.0-or-later */
/* frame_codec.h -- poses of a frame as whole numbers, predicted from the frames before, in planes of
 * bytes.
 *
 * Place: round(x / 2 BX) of each coordinate; the error is at most BX.  Rotation: of |w| |x| |y| |z| one is
 * left out, the largest, or that of the frame before while it is above 0.45; the sign of the quaternion is
 * such that it is positive.  The other three are rounded to multiples of s = BQ / 4.  Each errs by s/2 at
 * most and the one left out by (sum q_j d_j) / q_m, so that |dq| is at most 1.92 s (q_m = 0.45, three
 * equal others), and the rotation by 2 |dq| = 3.85 s < BQ.
 *
 * Residual of order 0, 1, 2:  a,  a - b,  a - 2b + c  modulo 2^32, with a, b, c the whole numbers of this
 * frame and of the two before; then zigzag, (d << 1) ^ (d >> 31).  A body whose left-out component is
 * another than in the frame before has order 0 in that frame, one frame later at most order 1.  Six
 * columns (x, y, z, the three of the rotation), each four planes of n bytes from the low one up; then n
 * bytes: the component left out, 0 w to 3 z, of order above 0 by exclusive or with that of the frame
 * before. A key has order 0 and numbers of its own: before the columns, as four planes, the zigzag of the
 * difference of each number less 1 from the one before (0 before the first). */
#ifndef FL_OUT_FRAME_CODEC_H
#define FL_OUT_FRAME_CODEC_H
#include <stdint.h>
#include "base/err.h"
#include "geom/quat.h"

enum { FL_FRAME_BODY_BYTES = 25 };

typedef struct {
    double bound_x, bound_q; /* BX [m], BQ [rad] */
    int32_t n, cap;          /* bodies */
    int32_t *id;             /* [n] */
    int32_t *column[3];      /* [6 n] whole numbers: now, before, before that */
    uint8_t *left_out[3];    /* [n] */
    int32_t since_key;       /* frames since the last key, the key counted; 0: the next must be one */
    uint8_t *planes;         /* [planes_cap] of the last frame */
    int32_t planes_cap, planes_len;
} fl_frame_codec;

/* Encodes a frame into `planes`; *order: that of its residuals, 0 for a key.  A key is written where the
 * numbers are not those of the frame before, and after key_every frames.  Returns 0, or -1 with FL_INPUT
 * (a place beyond what 32 bits hold) or FL_SYSTEM. */
int fl_frame_codec_encode(fl_frame_codec *c, int32_t n, const int32_t *id, const fl_vec3 *x, const fl_quat *q,
                          int32_t key_every, int *order, fl_err *err);

/* Bytes of the planes of n bodies. */
static inline int64_t fl_frame_codec_size(int32_t n, int is_key)
{
    return (int64_t)n * (FL_FRAME_BODY_BYTES + (is_key ? 4 : 0));
}

/* Makes room for the planes of n bodies in `planes`.  -1 with FL_SYSTEM. */
int fl_frame_codec_room(fl_frame_codec *c, int32_t n, fl_err *err);

/* Decodes `planes` of n bodies.  0, or -1: order and number of bodies do not follow from the frames
 * before. */
int fl_frame_codec_decode(fl_frame_codec *c, int32_t n, int is_key, int order);

/* The pose of body i of the frame encoded or decoded last. */
fl_vec3 fl_frame_codec_place(const fl_frame_codec *c, int32_t i);
fl_quat fl_frame_codec_rotation(const fl_frame_codec *c, int32_t i);

void fl_frame_codec_free(fl_frame_codec *c); /* accepts a zeroed struct, leaves one */

#endif
