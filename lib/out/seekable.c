/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>
#include "base/array.h"
#include "out/seekable.h"

enum { SPAN = 16 << 20, WINDOW = 32768, CHUNK = 1 << 18 };
enum { GZIP_HEADER = 15 + 16, RAW = -15, TRAILER = 8 };

/* A block boundary of the gzip file. */
struct mark {
    int64_t in, out; /* bytes of the file and of the text before it */
    int bits;        /* bits of the byte before `in` that belong to what follows */
    int have;        /* bytes of window */
    unsigned char *window;
};

struct fl_seekable {
    int fd, gzip, ended, cut;
    char *name;
    int64_t at; /* of the first pass: bytes of the file read */
    /* gzip: the first pass */
    z_stream z;
    int z_open, status;
    int64_t text, member, last_mark; /* bytes of text; at the start of the member; at the last mark */
    int ring_at;                     /* place in the ring */
    int64_t ready;                   /* bytes before it that were not handed out */
    struct mark *mark;
    int32_t marks, mark_cap;
    /* gzip: reading at a place */
    z_stream reader;
    int reader_open, reader_raw, reader_left; /* left: bytes of a member's check to pass over */
    int64_t reader_at, reader_text;           /* bytes of the file read, place in the text */
    unsigned char *work;                      /* [2 CHUNK] */
    unsigned char ring[WINDOW], in[CHUNK];
};

const char *fl_seekable_name(const fl_seekable *s) { return s->name; }
int fl_seekable_is_cut(const fl_seekable *s) { return s->cut; }

/* Up to n bytes of the file at `at`; the number, 0 at its end, -1 with FL_INPUT. */
static int64_t file_read(const fl_seekable *s, int64_t at, void *buf, int64_t n, fl_err *err)
{
    ssize_t k;
    do k = pread(s->fd, buf, (size_t)n, (off_t)at);
    while (k < 0 && errno == EINTR);
    return k < 0 ? fl_fail(err, FL_INPUT, "%s: %s", s->name, strerror(errno)) : k;
}

/* Copies a pipe into a file without a name. */
static int copy_pipe(fl_seekable *s, fl_err *err)
{
    const char *folder = getenv("TMPDIR");
    char path[4096];
    if (snprintf(path, sizeof path, "%s/ice-view.XXXXXX", folder && folder[0] ? folder : "/tmp") >=
        (int)sizeof path)
        return fl_fail(err, FL_SYSTEM, "TMPDIR is too long a name");
    const int fd = mkstemp(path);
    if (fd < 0) return fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
    unlink(path);
    for (;;) {
        ssize_t k = read(s->fd, s->in, CHUNK), written = 0;
        if (k < 0 && errno == EINTR) continue;
        if (k == 0) break;
        if (k < 0) {
            close(fd);
            return fl_fail(err, FL_INPUT, "%s: %s", s->name, strerror(errno));
        }
        while (written < k) {
            const ssize_t w = write(fd, s->in + written, (size_t)(k - written));
            if (w < 0 && errno != EINTR) {
                close(fd);
                return fl_fail(err, FL_SYSTEM, "a copy of %s: %s", s->name, strerror(errno));
            }
            if (w > 0) written += w;
        }
    }
    s->fd = fd; /* standard input stays open */
    return 0;
}

fl_seekable *fl_seekable_open(const char *path, fl_err *err)
{
    const int standard = strcmp(path, "-") == 0;
    struct stat st;
    fl_seekable *s = fl_alloc(1, sizeof *s, err);
    if (!s) return NULL;
    s->fd = -1;
    s->name = fl_alloc_text(standard ? "<stdin>" : path, err);
    if (!s->name) goto fail;
    s->fd = standard ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (s->fd < 0 || fstat(s->fd, &st) != 0 || S_ISDIR(st.st_mode)) {
        fl_fail(err, FL_INPUT, "%s: %s", s->name, strerror(s->fd < 0 ? errno : EISDIR));
        goto fail;
    }
    if (!S_ISREG(st.st_mode) || (standard && lseek(s->fd, 0, SEEK_CUR) != 0)) {
        if (copy_pipe(s, err)) goto fail;
    }
    const int64_t k = file_read(s, 0, s->in, 2, err);
    if (k < 0) goto fail;
    s->gzip = k == 2 && s->in[0] == 0x1f && s->in[1] == 0x8b;
    if (s->gzip) {
        if (inflateInit2(&s->z, GZIP_HEADER) != Z_OK) {
            fl_fail(err, FL_SYSTEM, "%s: out of memory for gzip", s->name);
            goto fail;
        }
        s->z_open = 1;
    }
    return s;
fail:
    fl_seekable_close(s);
    return NULL;
}

static int keep_mark(fl_seekable *s, fl_err *err)
{
    if (fl_grow(&s->mark, &s->mark_cap, (int64_t)s->marks + 1, sizeof *s->mark, err)) return -1;
    const int64_t made = s->text - s->member;
    struct mark *m = &s->mark[s->marks];
    *m = (struct mark){.in = s->at - s->z.avail_in,
                       .out = s->text,
                       .bits = s->z.data_type & 7,
                       .have = made < WINDOW ? (int)made : WINDOW};
    m->window = fl_alloc(WINDOW, 1, err);
    if (!m->window) return -1;
    for (int k = 0; k < m->have; k++) m->window[k] = s->ring[(s->ring_at - m->have + k) & (WINDOW - 1)];
    s->marks++;
    s->last_mark = s->text;
    return 0;
}

/* Inflates into the ring until something is ready.  0 at the end. */
static int inflate_more(fl_seekable *s, fl_err *err)
{
    while (!s->ready && !s->ended) {
        if (!s->z.avail_in) {
            const int64_t k = file_read(s, s->at, s->in, CHUNK, err);
            if (k < 0) return -1;
            if (k == 0) {
                s->ended = 1;
                s->cut = s->status != Z_STREAM_END;
                break;
            }
            s->at += k;
            s->z.next_in = s->in;
            s->z.avail_in = (uInt)k;
        }
        if (s->status == Z_STREAM_END) { /* another member; anything else ends the text, as gzip does */
            if (*s->z.next_in != 0x1f) {
                s->ended = 1;
                break;
            }
            inflateReset2(&s->z, GZIP_HEADER);
            s->member = s->text;
        }
        s->z.next_out = s->ring + s->ring_at;
        s->z.avail_out = (uInt)(WINDOW - s->ring_at);
        const uInt room = s->z.avail_out, given = s->z.avail_in;
        s->status = inflate(&s->z, Z_BLOCK);
        const int64_t got = room - s->z.avail_out;
        s->ring_at = (int)((s->ring_at + got) & (WINDOW - 1));
        s->text += got;
        s->ready = got;
        if (s->status != Z_OK && s->status != Z_STREAM_END &&
            !(s->status == Z_BUF_ERROR && (got || given != s->z.avail_in || !s->z.avail_in))) {
            s->ended = s->cut = 1;
            break;
        }
        if (s->status == Z_OK && (s->z.data_type & 128) && !(s->z.data_type & 64) &&
            (!s->marks || s->text - s->last_mark >= SPAN) && keep_mark(s, err))
            return -1;
    }
    return s->ready > 0;
}

int64_t fl_seekable_next(fl_seekable *s, void *buf, int64_t n, fl_err *err)
{
    if (!s->gzip) {
        const int64_t k = file_read(s, s->at, buf, n, err);
        if (k > 0) s->at += k;
        return k;
    }
    const int more = inflate_more(s, err);
    if (more <= 0) return more;
    int64_t from = (s->ring_at - s->ready) & (WINDOW - 1), k = s->ready < n ? s->ready : n;
    if (from + k > WINDOW) k = WINDOW - from;
    memcpy(buf, s->ring + from, (size_t)k);
    s->ready -= k;
    return k;
}

int fl_seekable_skip(fl_seekable *s, int64_t n, fl_err *err)
{
    unsigned char drop[4096];
    if (!s->gzip) {
        s->at += n;
        return 0;
    }
    while (n > 0) {
        const int64_t k = fl_seekable_next(s, drop, n < (int64_t)sizeof drop ? n : (int64_t)sizeof drop, err);
        if (k < 0) return -1;
        if (k == 0) break;
        n -= k;
    }
    return 0;
}

void fl_seekable_set_back(fl_seekable *s, int64_t offset)
{
    if (!s->gzip) s->at = offset;
}

/* Sets the reader at a mark. */
static int begin_reader(fl_seekable *s, const struct mark *m, fl_err *err)
{
    unsigned char first;
    if (s->reader_open) inflateEnd(&s->reader);
    s->reader_open = 0;
    s->reader = (z_stream){0};
    if (!s->work) s->work = fl_alloc(2 * CHUNK, 1, err);
    if (!s->work) return -1;
    if (inflateInit2(&s->reader, RAW) != Z_OK)
        return fl_fail(err, FL_SYSTEM, "%s: out of memory for gzip", s->name);
    s->reader_open = 1;
    s->reader_raw = 1;
    s->reader_left = 0;
    s->reader_at = m->in;
    s->reader_text = m->out;
    if (m->bits) {
        if (file_read(s, m->in - 1, &first, 1, err) != 1) return -1;
        inflatePrime(&s->reader, m->bits, first >> (8 - m->bits));
    }
    inflateSetDictionary(&s->reader, m->window, (uInt)m->have);
    return 0;
}

/* Up to `room` bytes from where the reader stands.  Their number, or -1. */
static int64_t reader_next(fl_seekable *s, unsigned char *to, int64_t room, fl_err *err)
{
    z_stream *const z = &s->reader;
    for (;;) {
        if (!z->avail_in) {
            const int64_t k = file_read(s, s->reader_at, s->work, CHUNK, err);
            if (k <= 0) return -1;
            s->reader_at += k;
            z->next_in = s->work;
            z->avail_in = (uInt)k;
        }
        if (s->reader_left) { /* a raw stream leaves the check of its member to us */
            s->reader_left--;
            z->avail_in--;
            z->next_in++;
            if (!s->reader_left) inflateReset2(z, GZIP_HEADER);
            continue;
        }
        z->next_out = to;
        z->avail_out = (uInt)room;
        const int r = inflate(z, Z_NO_FLUSH);
        const int64_t made = room - z->avail_out;
        if (r == Z_STREAM_END) {
            if (s->reader_raw) s->reader_left = TRAILER;
            else inflateReset2(z, GZIP_HEADER);
            s->reader_raw = 0;
        } else if (r != Z_OK && r != Z_BUF_ERROR) return -1;
        if (made) {
            s->reader_text += made;
            return made;
        }
    }
}

/* n bytes from `offset`: from where the reader stands, or from the last mark before, whichever is nearer. */
static int read_gzip(fl_seekable *s, int64_t offset, unsigned char *buf, int64_t n, fl_err *err)
{
    int lo = 0;
    for (int hi = s->marks; lo + 1 < hi;) {
        const int mid = (lo + hi) / 2;
        if (s->mark[mid].out <= offset) lo = mid;
        else hi = mid;
    }
    if (!s->marks || s->mark[lo].out > offset) goto other;
    if (!s->reader_open || s->reader_text > offset || s->reader_text < s->mark[lo].out) {
        if (begin_reader(s, &s->mark[lo], err)) goto other;
    }
    while (n > 0) {
        const int64_t skip = offset - s->reader_text, want = skip ? skip : n;
        const int64_t k = reader_next(s, skip ? s->work + CHUNK : buf, want < CHUNK ? want : CHUNK, err);
        if (k < 0) goto other;
        if (skip) continue;
        buf += k;
        offset += k;
        n -= k;
    }
    return 0;
other:
    if (s->reader_open) inflateEnd(&s->reader);
    s->reader_open = 0;
    return err->code ? -1 : fl_fail(err, FL_INPUT, "%s: has changed since it was opened", s->name);
}

int fl_seekable_read(fl_seekable *s, int64_t offset, void *buf, int64_t n, fl_err *err)
{
    unsigned char *to = buf;
    if (s->gzip) return n ? read_gzip(s, offset, to, n, err) : 0;
    while (n > 0) {
        const int64_t k = file_read(s, offset, to, n, err);
        if (k < 0) return -1;
        if (k == 0) return fl_fail(err, FL_INPUT, "%s: has become shorter since it was opened", s->name);
        to += k;
        offset += k;
        n -= k;
    }
    return 0;
}

void fl_seekable_close(fl_seekable *s)
{
    if (!s) return;
    if (s->z_open) inflateEnd(&s->z);
    if (s->reader_open) inflateEnd(&s->reader);
    free(s->work);
    for (int32_t k = 0; k < s->marks; k++) free(s->mark[k].window);
    free(s->mark);
    if (s->fd > STDIN_FILENO) close(s->fd);
    free(s->name);
    free(s);
}
