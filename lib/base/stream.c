/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* fopencookie */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>
#include "base/mem.h"
#include "base/stream.h"

enum { CHUNK = 1 << 16 };

struct fl_in {
    int fd, gzip, ended;
    const char *name; /* borrowed */
    double patience;  /* [s] */
    z_stream z;
    int64_t have, pos;
    unsigned char buf[CHUNK];
};

/* Refill the raw buffer; 0 at the end of the file. */
static int64_t raw_fill(fl_in *in, fl_err *err)
{
    const struct timespec pause = {.tv_nsec = 50000000};
    ssize_t k;
    double waited = 0.0;
    for (;;) {
        do k = read(in->fd, in->buf, CHUNK);
        while (k < 0 && errno == EINTR);
        if (k != 0 || waited >= in->patience) break;
        nanosleep(&pause, NULL);
        waited += 1e-9 * (double)pause.tv_nsec;
    }
    if (k < 0) return fl_fail(err, FL_INPUT, "%s: %s", in->name, strerror(errno));
    in->have = k;
    in->pos = 0;
    return k;
}

fl_in *fl_in_open(const char *path, fl_err *err)
{
    struct stat st;
    const int std = strcmp(path, "-") == 0;
    fl_in *in = fl_alloc(1, sizeof *in, err);
    if (!in) return NULL;
    in->name = std ? "<stdin>" : path;
    in->fd = std ? STDIN_FILENO : open(path, O_RDONLY | O_CLOEXEC);
    if (in->fd < 0 || (fstat(in->fd, &st) == 0 && S_ISDIR(st.st_mode))) {
        fl_fail(err, FL_INPUT, "%s: %s", in->name, strerror(in->fd < 0 ? errno : EISDIR));
        goto fail;
    }
    /* Two bytes decide; a pipe may hand over the first alone. */
    if (raw_fill(in, err) < 0) goto fail;
    while (in->have == 1) {
        ssize_t k = read(in->fd, in->buf + 1, CHUNK - 1);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) break;
        in->have += k;
    }
    in->gzip = in->have >= 2 && in->buf[0] == 0x1f && in->buf[1] == 0x8b;
    if (in->gzip && inflateInit2(&in->z, 15 + 16) != Z_OK) {
        in->gzip = 0;
        fl_fail(err, FL_SYSTEM, "%s: out of memory for gzip", in->name);
        goto fail;
    }
    return in;
fail:
    fl_in_close(in);
    return NULL;
}

static int64_t plain_read(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    int64_t k = in->have - in->pos;
    if (k == 0) {
        k = raw_fill(in, err);
        if (k <= 0) return k;
    }
    if (k > n) k = n;
    memcpy(buf, in->buf + in->pos, (size_t)k);
    in->pos += k;
    return k;
}

static int64_t gzip_read(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    in->z.next_out = buf;
    in->z.avail_out = (uInt)(n > CHUNK ? CHUNK : n);
    const uInt asked = in->z.avail_out;
    while (in->z.avail_out == asked && !in->ended) {
        int rc;
        if (in->pos == in->have) {
            const int64_t k = raw_fill(in, err);
            if (k < 0) return -1;
            if (k == 0) return fl_fail(err, FL_INPUT, "%s: gzip data end early", in->name);
        }
        in->z.next_in = in->buf + in->pos;
        in->z.avail_in = (uInt)(in->have - in->pos);
        rc = inflate(&in->z, Z_NO_FLUSH);
        in->pos = in->have - (int64_t)in->z.avail_in;
        if (rc == Z_STREAM_END) { /* another member may follow: gzip files may be concatenated */
            if (in->pos == in->have && raw_fill(in, err) < 0) return -1;
            if (in->have - in->pos > 0) inflateReset(&in->z);
            else in->ended = 1;
        } else if (rc != Z_OK && rc != Z_BUF_ERROR) {
            return fl_fail(err, FL_INPUT, "%s: damaged gzip data", in->name);
        }
    }
    return (int64_t)(asked - in->z.avail_out);
}

int64_t fl_in_read(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    return in->gzip ? gzip_read(in, buf, n, err) : plain_read(in, buf, n, err);
}

void fl_in_patience(fl_in *in, double seconds) { in->patience = seconds; }

const char *fl_in_name(const fl_in *in) { return in->name; }

void fl_in_close(fl_in *in)
{
    if (!in) return;
    if (in->gzip) inflateEnd(&in->z);
    if (in->fd > STDIN_FILENO) close(in->fd);
    free(in);
}

/* --- out --------------------------------------------------------------------------------------- */

static ssize_t gz_cookie_write(void *gz, const char *buf, size_t n)
{
    return n && gzwrite(gz, buf, (unsigned)n) != (int)n ? 0 : (ssize_t)n;
}

int fl_out_open(fl_out *out, const char *path, int gzip, fl_err *err)
{
    int fd = STDOUT_FILENO;
    struct stat st;
    *out = (fl_out){0};
    if (strcmp(path, "-") != 0) {
        /* Renaming over a link or a device would put a plain file in its place: /dev/null, /dev/stdout. */
        out->path = lstat(path, &st) == 0 && S_ISLNK(st.st_mode) ? realpath(path, NULL) : NULL;
        if (!out->path) out->path = strdup(path);
        const int direct = out->path && stat(out->path, &st) == 0 && !S_ISREG(st.st_mode);
        if (out->path && !direct && asprintf(&out->tmp, "%s.part", out->path) < 0) out->tmp = NULL;
        if (!out->path || (!direct && !out->tmp)) {
            fl_fail(err, FL_SYSTEM, "out of memory");
            goto fail;
        }
        fd = open(direct ? out->path : out->tmp, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        if (fd < 0) {
            fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
            free(out->tmp);
            out->tmp = NULL;
            goto fail;
        }
    }
    if (gzip) {
        out->gz = gzdopen(dup(fd), "wb6");
        if (out->gz) out->f = fopencookie(out->gz, "w", (cookie_io_functions_t){.write = gz_cookie_write});
        if (fd != STDOUT_FILENO) close(fd);
    } else {
        out->f = fd == STDOUT_FILENO ? stdout : fdopen(fd, "w");
    }
    if (out->f) return 0;
    fl_fail(err, FL_SYSTEM, "%s: cannot open for writing", path);
fail:
    fl_out_abort(out);
    return -1;
}

int fl_out_close(fl_out *out, fl_err *err)
{
    const char *name = out->path ? out->path : "<stdout>";
    int bad;
    if (!out->f) return 0;
    if (!ferror(out->f)) errno = 0; /* else the last write that failed has left why */
    bad = fflush(out->f) != 0 || ferror(out->f);
    if (!bad && !out->gz && out->path) bad = fsync(fileno(out->f)) != 0 && errno != EINVAL && errno != EROFS;
    if (out->f != stdout) bad |= fclose(out->f) != 0;
    out->f = NULL;
    if (out->gz) bad |= gzclose(out->gz) != Z_OK;
    out->gz = NULL;
    if (!bad && out->tmp) bad = rename(out->tmp, out->path) != 0;
    if (bad) fl_fail(err, FL_SYSTEM, "%s: %s", name, errno ? strerror(errno) : "could not write all of it");
    else if (out->tmp) {
        free(out->tmp);
        out->tmp = NULL;
    }
    fl_out_abort(out);
    return bad ? -1 : 0;
}

void fl_out_abort(fl_out *out)
{
    if (out->f && out->f != stdout) fclose(out->f);
    if (out->gz) gzclose(out->gz);
    if (out->tmp) unlink(out->tmp);
    free(out->tmp);
    free(out->path);
    *out = (fl_out){0};
}
