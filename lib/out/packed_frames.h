/* SPDX-License-Identifier: GPL-3.0-or-later */
/* packed_frames.h -- frames in packed form, animation(5) version 2: blocks behind the text of shapes and
 * parts.
 *
 * A block is 16 bytes, kind, stored length, inflated length, CRC-32 of what is stored, little-endian, and
 * what is stored.  FRAM: t (double), n, order, flags, two zero bytes, then a zlib stream of the planes of
 * frame_codec.h, the way of the structure, moved parts.  TEXT: a zlib stream of records of version 1,
 * shapes that come in. */
#ifndef FL_OUT_PACKED_FRAMES_H
#define FL_OUT_PACKED_FRAMES_H
#include <stdio.h>
#include "out/frame_codec.h"
#include "out/frame_data.h"

/* Of the flags of a frame. */
enum { FL_PACKED_KEY = 1, FL_PACKED_NO_BODIES = 4, FL_PACKED_STRUCTURE = 8, FL_PACKED_MOVED = 16 };

/* Bounds [m], [rad], and frames between keys, where nothing else is given. */
#define FL_PACKED_BOUND_X 1e-5
#define FL_PACKED_BOUND_Q 1e-5
enum { FL_PACKED_KEY_EVERY = 16 };

typedef struct {
    fl_frame_codec codec;
    int32_t key_every;
    /* A frame under way: filled by the caller through the functions below. */
    int32_t n, cap, id_cap, x_cap;
    int32_t *id;
    fl_vec3 *x;
    fl_quat *q;
    unsigned char *rest; /* behind the planes */
    int32_t rest_len, rest_cap, moved;
    unsigned char *stored;
    int32_t stored_cap;
} fl_packed_writer;

fl_packed_writer fl_packed_writer_make(double bound_x, double bound_q, int32_t key_every);

/* Write the line that ends the text, from which on the file has blocks. */
void fl_packed_frames_begin(FILE *f, const fl_packed_writer *w);

/* Write records of shapes as a block.  -1 with FL_SYSTEM. */
int fl_packed_frames_text(FILE *f, fl_packed_writer *w, const char *text, int64_t n, fl_err *err);

/* A frame: clear, add its bodies and moved parts, write.  displacement: way of the structure, NULL: none.
 * bodies 0: those of the frame before stand.  -1 with FL_SYSTEM, or FL_INPUT for a place beyond the bound. */
void fl_packed_frame_clear(fl_packed_writer *w);
int fl_packed_frame_body(fl_packed_writer *w, int32_t id, fl_vec3 x, fl_quat q, fl_err *err);
int fl_packed_frame_part(fl_packed_writer *w, int32_t id, fl_vec3 x, fl_quat q, fl_err *err);
int fl_packed_frame_write(FILE *f, fl_packed_writer *w, double t, int bodies, const fl_vec3 *displacement,
                          fl_err *err);

/* The next frame is a key: after a checkpoint, since a run that resumes does not know the frames before. */
void fl_packed_writer_restart(fl_packed_writer *w);
void fl_packed_writer_free(fl_packed_writer *w);

/* --- reading --- */

enum { FL_PACKED_BLOCK = 16, FL_PACKED_FRAME = 16 };

typedef struct {
    char kind[5];
    int64_t stored, inflated;
    uint32_t crc;
} fl_packed_block;

/* The head of a block.  0, or -1 where it is none. */
int fl_packed_block_read(const unsigned char head[FL_PACKED_BLOCK], fl_packed_block *b);

typedef struct {
    double t;
    int32_t n, order, flags;
} fl_packed_frame;

/* The head of a frame.  0, or -1 where it is none. */
int fl_packed_frame_read(const unsigned char head[FL_PACKED_FRAME], fl_packed_frame *h);

/* Inflates stored[b->stored) from `skip` on.  The bytes, to be freed; NULL with FL_INPUT or FL_SYSTEM. */
unsigned char *fl_packed_inflate(const char *name, const fl_packed_block *b, const unsigned char *stored,
                                 int64_t skip, fl_err *err);

/* The structure and the moved parts behind the planes.  -1 with FL_INPUT. */
int fl_packed_frame_parts(const fl_frame_data *d, const char *name, const fl_packed_frame *h,
                          const unsigned char *bytes, int64_t n, fl_frame *out, fl_err *err);

#endif
