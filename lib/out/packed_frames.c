/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stdlib.h>
#include <string.h>
#include <zlib.h>
#include "base/array.h"
#include "base/number_text.h"
#include "out/frame_text.h"
#include "out/packed_frames.h"

enum { MEMORY = 9, WINDOW_BITS = 15, BLOCK_MAX = 1 << 30, POSE_BYTES = 56 };

static void put_uint(unsigned char *to, uint64_t x, int bytes)
{
    for (int k = 0; k < bytes; k++) to[k] = (unsigned char)(x >> (8 * k));
}

static uint64_t get_uint(const unsigned char *from, int bytes)
{
    uint64_t x = 0;
    for (int k = 0; k < bytes; k++) x |= (uint64_t)from[k] << (8 * k);
    return x;
}

static void put_double(unsigned char *to, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    put_uint(to, bits, 8);
}

static double get_double(const unsigned char *from)
{
    const uint64_t bits = get_uint(from, 8);
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* --- writing ----------------------------------------------------------------------------------- */

fl_packed_writer fl_packed_writer_make(double bound_x, double bound_q, int32_t key_every)
{
    return (fl_packed_writer){.codec = {.bound_x = bound_x, .bound_q = bound_q}, .key_every = key_every};
}

void fl_packed_writer_restart(fl_packed_writer *w) { w->codec.since_key = 0; }

void fl_packed_writer_free(fl_packed_writer *w)
{
    fl_frame_codec_free(&w->codec);
    free(w->id);
    free(w->x);
    free(w->q);
    free(w->rest);
    free(w->stored);
    *w = (fl_packed_writer){0};
}

void fl_packed_frames_begin(FILE *f, const fl_packed_writer *w)
{
    char bx[FL_NUMBER_LEN], bq[FL_NUMBER_LEN];
    fprintf(f, "packed %s %s %d\n", fl_number_text(w->codec.bound_x, bx),
            fl_number_text(w->codec.bound_q, bq), w->key_every);
}

/* Writes a block of `head` and the deflated `a` and `b`.  Runs and Huffman codes only (Z_RLE) are smaller
 * here, and faster, than a search for strings. */
static int write_block(FILE *f, fl_packed_writer *w, const char *kind, const unsigned char *head,
                       int32_t head_len, const unsigned char *a, int64_t a_len, const unsigned char *b,
                       int64_t b_len, int strategy, fl_err *err)
{
    unsigned char block[FL_PACKED_BLOCK];
    z_stream z = {0};
    if (a_len + b_len > BLOCK_MAX)
        return fl_fail(err, FL_SYSTEM, "packed frames: a block of more than 1 GiB");
    if (deflateInit2(&z, 1, Z_DEFLATED, WINDOW_BITS, MEMORY, strategy) != Z_OK)
        return fl_fail(err, FL_SYSTEM, "out of memory for packed frames");
    const int64_t room = head_len + (int64_t)deflateBound(&z, (uLong)(a_len + b_len)) + 64;
    if (fl_grow(&w->stored, &w->stored_cap, room, 1, err)) {
        deflateEnd(&z);
        return -1;
    }
    if (head_len) memcpy(w->stored, head, (size_t)head_len);
    z.next_out = w->stored + head_len;
    z.avail_out = (uInt)(room - head_len);
    memcpy(&z.next_in, &a, sizeof a); /* zlib takes a pointer to what it does not change */
    z.avail_in = (uInt)a_len;
    if (a_len) deflate(&z, Z_NO_FLUSH);
    memcpy(&z.next_in, &b, sizeof b);
    z.avail_in = (uInt)b_len;
    const int end = deflate(&z, Z_FINISH);
    const int64_t stored = head_len + (int64_t)z.total_out;
    deflateEnd(&z);
    if (end != Z_STREAM_END) return fl_fail(err, FL_SYSTEM, "zlib did not end a block of packed frames");
    memcpy(block, kind, 4);
    put_uint(block + 4, (uint64_t)stored, 4);
    put_uint(block + 8, (uint64_t)(a_len + b_len), 4);
    put_uint(block + 12, crc32(0, w->stored, (uInt)stored), 4);
    fwrite(block, 1, sizeof block, f); /* errors stay in f, for fl_out_close() */
    fwrite(w->stored, 1, (size_t)stored, f);
    return 0;
}

int fl_packed_frames_text(FILE *f, fl_packed_writer *w, const char *text, int64_t n, fl_err *err)
{
    return n ? write_block(f, w, "TEXT", NULL, 0, (const unsigned char *)text, n, NULL, 0, Z_DEFAULT_STRATEGY,
                           err)
             : 0;
}

void fl_packed_frame_clear(fl_packed_writer *w) { w->n = w->rest_len = w->moved = 0; }

int fl_packed_frame_body(fl_packed_writer *w, int32_t id, fl_vec3 x, fl_quat q, fl_err *err)
{
    const int64_t want = (int64_t)w->n + 1;
    if (fl_grow(&w->id, &w->id_cap, want, sizeof *w->id, err) ||
        fl_grow(&w->x, &w->x_cap, want, sizeof *w->x, err) ||
        fl_grow(&w->q, &w->cap, want, sizeof *w->q, err))
        return -1;
    w->id[w->n] = id;
    w->x[w->n] = x;
    w->q[w->n++] = q;
    return 0;
}

static int put_rest(fl_packed_writer *w, const double *x, int n, fl_err *err)
{
    if (fl_grow(&w->rest, &w->rest_cap, (int64_t)w->rest_len + 8 * n, 1, err)) return -1;
    for (int k = 0; k < n; k++, w->rest_len += 8) put_double(w->rest + w->rest_len, x[k]);
    return 0;
}

int fl_packed_frame_part(fl_packed_writer *w, int32_t id, fl_vec3 x, fl_quat q, fl_err *err)
{
    const double pose[7] = {x.x, x.y, x.z, q.w, q.x, q.y, q.z};
    if (fl_grow(&w->rest, &w->rest_cap, (int64_t)w->rest_len + 4, 1, err)) return -1;
    put_uint(w->rest + w->rest_len, (uint32_t)id, 4);
    w->rest_len += 4;
    w->moved++;
    return put_rest(w, pose, 7, err);
}

int fl_packed_frame_write(FILE *f, fl_packed_writer *w, double t, int bodies, const fl_vec3 *displacement,
                          fl_err *err)
{
    unsigned char head[FL_PACKED_FRAME] = {0}, front[28];
    int32_t front_len = 0, flags = bodies ? 0 : FL_PACKED_NO_BODIES;
    int order = 0;
    if (bodies) {
        if (fl_frame_codec_encode(&w->codec, w->n, w->id, w->x, w->q, w->key_every, &order, err)) return -1;
        if (w->codec.since_key == 1) flags |= FL_PACKED_KEY;
    }
    if (displacement) {
        flags |= FL_PACKED_STRUCTURE;
        put_double(front, displacement->x);
        put_double(front + 8, displacement->y);
        put_double(front + 16, displacement->z);
        front_len = 24;
    }
    if (w->moved) {
        flags |= FL_PACKED_MOVED;
        put_uint(front + front_len, (uint32_t)w->moved, 4);
        front_len += 4;
    }
    /* The front stands before the parts that have been added. */
    if (fl_grow(&w->rest, &w->rest_cap, (int64_t)w->rest_len + front_len, 1, err)) return -1;
    if (w->rest_len) memmove(w->rest + front_len, w->rest, (size_t)w->rest_len);
    if (front_len) memcpy(w->rest, front, (size_t)front_len);
    w->rest_len += front_len;
    put_double(head, t);
    put_uint(head + 8, (uint32_t)(bodies ? w->n : 0), 4);
    head[12] = (unsigned char)order;
    head[13] = (unsigned char)flags;
    return write_block(f, w, "FRAM", head, FL_PACKED_FRAME, w->codec.planes, bodies ? w->codec.planes_len : 0,
                       w->rest, w->rest_len, Z_RLE, err);
}

/* --- reading ----------------------------------------------------------------------------------- */

int fl_packed_block_read(const unsigned char head[FL_PACKED_BLOCK], fl_packed_block *b)
{
    memcpy(b->kind, head, 4);
    b->kind[4] = '\0';
    b->stored = (int64_t)get_uint(head + 4, 4);
    b->inflated = (int64_t)get_uint(head + 8, 4);
    b->crc = (uint32_t)get_uint(head + 12, 4);
    if (b->inflated > BLOCK_MAX || b->stored > BLOCK_MAX) return -1;
    if (strcmp(b->kind, "FRAM") == 0) return b->stored < FL_PACKED_FRAME ? -1 : 0;
    return strcmp(b->kind, "TEXT") == 0 ? 0 : -1;
}

int fl_packed_frame_read(const unsigned char head[FL_PACKED_FRAME], fl_packed_frame *h)
{
    const uint64_t n = get_uint(head + 8, 4);
    h->t = get_double(head);
    h->n = n > BLOCK_MAX / FL_FRAME_BODY_BYTES ? -1 : (int32_t)n;
    h->order = head[12];
    h->flags = head[13];
    return h->n < 0 || h->order > 2 || !(h->t > -1e15 && h->t < 1e15) || (h->flags & ~29) || head[14] ||
                   head[15] || ((h->flags & FL_PACKED_NO_BODIES) && (h->n || (h->flags & FL_PACKED_KEY)))
               ? -1
               : 0;
}

unsigned char *fl_packed_inflate(const char *name, const fl_packed_block *b, const unsigned char *stored,
                                 int64_t skip, fl_err *err)
{
    uLongf got = (uLongf)b->inflated;
    if (crc32(0, stored, (uInt)b->stored) != b->crc) {
        fl_fail(err, FL_INPUT, "%s: the check sum of a block is wrong: the file is damaged", name);
        return NULL;
    }
    /* A block cannot hold more than its stored bytes can unpack to (zlib: 1032 times as much). */
    if (b->inflated > 1040 * b->stored + 64) {
        fl_fail(err, FL_INPUT, "%s: a block announces more than it can hold", name);
        return NULL;
    }
    unsigned char *bytes = fl_alloc(b->inflated + 1, 1, err);
    if (!bytes) return NULL;
    const int rc = uncompress(bytes, &got, stored + skip, (uLong)(b->stored - skip));
    if (rc != Z_OK || (int64_t)got != b->inflated) {
        fl_fail(err, rc == Z_MEM_ERROR ? FL_SYSTEM : FL_INPUT,
                "%s: a block does not unpack: the file is damaged", name);
        free(bytes);
        return NULL;
    }
    return bytes;
}

int fl_packed_frame_parts(const fl_frame_data *d, const char *name, const fl_packed_frame *h,
                          const unsigned char *bytes, int64_t n, fl_frame *out, fl_err *err)
{
    const unsigned char *at = bytes, *const end = bytes + n;
    if (h->flags & FL_PACKED_STRUCTURE) {
        if (end - at < 24) goto short_of;
        const fl_vec3 x = v3(get_double(at), get_double(at + 8), get_double(at + 16));
        if (fl_frame_set_part(d, name, 0, -1, x, q_one(), out, err)) return -1;
        at += 24;
    }
    if (h->flags & FL_PACKED_MOVED) {
        if (end - at < 4) goto short_of;
        const int64_t parts = (int64_t)get_uint(at, 4);
        at += 4;
        if (end - at != parts * (POSE_BYTES + 4)) goto short_of;
        for (int64_t k = 0; k < parts; k++, at += POSE_BYTES + 4) {
            const fl_vec3 x = v3(get_double(at + 4), get_double(at + 12), get_double(at + 20));
            const fl_quat q = {get_double(at + 28), get_double(at + 36), get_double(at + 44),
                               get_double(at + 52)};
            const uint64_t id = get_uint(at, 4);
            if (fl_frame_set_part(d, name, 0, id > INT32_MAX ? INT32_MAX : (int32_t)id, x, q, out, err))
                return -1;
        }
    }
    if (at == end) return 0;
short_of:
    return fl_fail(err, FL_INPUT, "%s: frame of %g s has not the length that its head announces", name, h->t);
}
