/* SPDX-License-Identifier: GPL-3.0-or-later */
#define _GNU_SOURCE /* fopencookie, flock */
#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>
#include <zlib.h>
#include "base/array.h"
#include "base/parallel.h"
#include "base/stream.h"

enum { CHUNK = 1 << 16 };

struct fl_in {
    int fd, gzip, ended;
    const char *name;           /* borrowed */
    double follow_seconds;      /* [s] */
    const unsigned char *bytes; /* data in memory instead of fd, borrowed */
    int64_t bytes_left;         /* bytes not yet copied to buf */
    z_stream z;
    int64_t buf_len, buf_pos;
    unsigned char buf[CHUNK];
};

/* Refills the raw buffer.  Returns 0 at the end of the file. */
static int64_t fill_buffer(fl_in *in, fl_err *err)
{
    const struct timespec pause = {.tv_nsec = 50000000};
    ssize_t k;
    double waited = 0.0;
    if (in->bytes) {
        in->buf_pos = 0;
        in->buf_len = in->bytes_left < CHUNK ? in->bytes_left : CHUNK;
        if (in->buf_len) memcpy(in->buf, in->bytes, (size_t)in->buf_len);
        in->bytes += in->buf_len;
        in->bytes_left -= in->buf_len;
        return in->buf_len;
    }
    for (;;) {
        do k = read(in->fd, in->buf, CHUNK);
        while (k < 0 && errno == EINTR);
        if (k != 0 || waited >= in->follow_seconds) break;
        nanosleep(&pause, NULL);
        waited += 1e-9 * (double)pause.tv_nsec;
    }
    if (k < 0) return fl_fail(err, FL_INPUT, "%s: %s", in->name, strerror(errno));
    in->buf_len = k;
    in->buf_pos = 0;
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
    /* Two bytes identify gzip; a pipe may deliver the first one alone. */
    if (fill_buffer(in, err) < 0) goto fail;
    while (in->buf_len == 1) {
        ssize_t k = read(in->fd, in->buf + 1, CHUNK - 1);
        if (k < 0 && errno == EINTR) continue;
        if (k <= 0) break;
        in->buf_len += k;
    }
    in->gzip = in->buf_len >= 2 && in->buf[0] == 0x1f && in->buf[1] == 0x8b;
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

fl_in *fl_in_open_bytes(const char *name, const void *data, int64_t n, fl_err *err)
{
    fl_in *in = fl_alloc(1, sizeof *in, err);
    if (!in) return NULL;
    in->name = name;
    in->fd = -1;
    in->bytes = data;
    in->bytes_left = n;
    return in;
}

static int64_t read_plain(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    int64_t k = in->buf_len - in->buf_pos;
    if (k == 0) {
        k = fill_buffer(in, err);
        if (k <= 0) return k;
    }
    if (k > n) k = n;
    memcpy(buf, in->buf + in->buf_pos, (size_t)k);
    in->buf_pos += k;
    return k;
}

static int64_t read_gzip(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    in->z.next_out = buf;
    in->z.avail_out = (uInt)(n > CHUNK ? CHUNK : n);
    const uInt asked = in->z.avail_out;
    while (in->z.avail_out == asked && !in->ended) {
        int rc;
        if (in->buf_pos == in->buf_len) {
            const int64_t k = fill_buffer(in, err);
            if (k < 0) return -1;
            if (k == 0) return fl_fail(err, FL_INPUT, "%s: gzip data end early", in->name);
        }
        in->z.next_in = in->buf + in->buf_pos;
        in->z.avail_in = (uInt)(in->buf_len - in->buf_pos);
        rc = inflate(&in->z, Z_NO_FLUSH);
        in->buf_pos = in->buf_len - (int64_t)in->z.avail_in;
        if (rc == Z_STREAM_END) { /* another member may follow: gzip files may be concatenated */
            if (in->buf_pos == in->buf_len && fill_buffer(in, err) < 0) return -1;
            if (in->buf_len - in->buf_pos > 0) inflateReset(&in->z);
            else in->ended = 1;
        } else if (rc != Z_OK && rc != Z_BUF_ERROR) {
            return fl_fail(err, FL_INPUT, "%s: damaged gzip data", in->name);
        }
    }
    return (int64_t)(asked - in->z.avail_out);
}

int64_t fl_in_read(fl_in *in, void *buf, int64_t n, fl_err *err)
{
    return in->gzip ? read_gzip(in, buf, n, err) : read_plain(in, buf, n, err);
}

void fl_in_follow(fl_in *in, double seconds) { in->follow_seconds = seconds; }

const char *fl_in_name(const fl_in *in) { return in->name; }

void fl_in_close(fl_in *in)
{
    if (!in) return;
    if (in->gzip) inflateEnd(&in->z);
    if (in->fd > STDIN_FILENO) close(in->fd);
    free(in);
}

/* --- output ------------------------------------------------------------------------------------ */

/* The target of fl_out.gz.  A gzip member starts with the first byte written after the previous one ended. */
typedef struct {
    gzFile gz; /* NULL between members */
    int fd, level;
} gzip_writer;

static int begin_member(gzip_writer *z)
{
    const int fd = dup(z->fd);
    z->gz = fd < 0 ? NULL : gzdopen(fd, z->level > 1 ? "wb1" : "wb6");
    if (!z->gz && fd >= 0) close(fd);
    return z->gz ? 0 : -1;
}

static int end_member(gzip_writer *z)
{
    const int rc = z->gz ? gzclose(z->gz) : Z_OK;
    z->gz = NULL;
    return rc == Z_OK ? 0 : -1;
}

static ssize_t write_gzip(void *cookie, const char *buf, size_t n)
{
    gzip_writer *z = cookie;
    if (n && !z->gz && begin_member(z)) return 0;
    return n && gzwrite(z->gz, buf, (unsigned)n) != (int)n ? 0 : (ssize_t)n;
}

/* Opens the stream on fd.  On failure fd is closed. */
static int open_stream(fl_out *out, int fd, int gzip, fl_err *err)
{
    if (gzip) {
        gzip_writer *z = fl_alloc(1, sizeof *z, err);
        if (!z) goto fail;
        *z = (gzip_writer){NULL, fd, gzip};
        out->gz = z;
        if (begin_member(z) == 0) out->f = fopencookie(z, "w", (cookie_io_functions_t){.write = write_gzip});
        if (out->f) return 0;
    } else {
        out->f = fd == STDOUT_FILENO ? stdout : fdopen(fd, "w");
        if (out->f) return 0;
    }
    fl_fail(err, FL_SYSTEM, "%s: cannot open for writing", out->path ? out->path : "<stdout>");
fail:
    if (!out->gz && fd != STDOUT_FILENO) close(fd);
    return -1;
}

static int fd_of(const fl_out *out) { return out->gz ? ((gzip_writer *)out->gz)->fd : fileno(out->f); }

/* Resolves the names for path.  Renaming onto a link or a device (/dev/null, /dev/stdout) would replace it
 * with a plain file.  *direct is set where path is not a plain file. */
static int resolve_names(fl_out *out, const char *path, int *direct, fl_err *err)
{
    struct stat st;
    *out = (fl_out){0};
    out->path = lstat(path, &st) == 0 && S_ISLNK(st.st_mode) ? realpath(path, NULL) : NULL;
    if (!out->path) out->path = strdup(path);
    *direct = out->path && stat(out->path, &st) == 0 && !S_ISREG(st.st_mode);
    if (out->path && !*direct && asprintf(&out->tmp, "%s.part", out->path) < 0) out->tmp = NULL;
    if (out->path && (*direct || out->tmp)) return 0;
    free(out->path);
    out->path = NULL;
    return fl_fail(err, FL_SYSTEM, "out of memory");
}

char *fl_out_part_path(const char *path)
{
    fl_out out;
    fl_err err = {0};
    int direct;
    if (resolve_names(&out, path, &direct, &err)) return NULL;
    free(out.path);
    return out.tmp;
}

/* Reports that a file could not be created.  A missing folder is named instead of the file. */
static void report_create_error(const char *path, fl_err *err)
{
    const int why = errno;
    char *folder = strdup(path), *slash = folder ? strrchr(folder, '/') : NULL;
    if (slash && slash != folder) *slash = '\0';
    else slash = NULL;
    if (why == ENOENT && slash && access(folder, F_OK))
        fl_fail(err, FL_SYSTEM, "%s: there is no folder %s", path, folder);
    else fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(why));
    free(folder);
}

/* Opens tmp for a single writer; creates it if `make`.  The lock ends with the last descriptor, however the
 * program ends, and stays with the file through a rename.  When the lock is obtained the name may belong to
 * another file; that file is tried next.  File systems without locks
 * get none.  Returns the descriptor or -1. */
static int open_locked(fl_out *out, int make, fl_err *err)
{
    for (;;) {
        struct stat ours, named;
        const int fd = open(out->tmp, O_RDWR | (make ? O_CREAT : 0) | O_CLOEXEC, 0666);
        if (fd < 0) {
            report_create_error(out->path, err);
            return -1;
        }
        if (flock(fd, LOCK_EX | LOCK_NB) && errno == EWOULDBLOCK) {
            fl_fail(err, FL_SYSTEM,
                    "%s: it is already being written, by another run or another output of this one",
                    out->path);
            close(fd);
            return -1;
        }
        if (fstat(fd, &ours) == 0 && stat(out->tmp, &named) == 0 && ours.st_dev == named.st_dev &&
            ours.st_ino == named.st_ino)
            return fd;
        close(fd);
        if (!make) {
            fl_fail(err, FL_SYSTEM, "%s: it was removed while it was being opened", out->path);
            return -1;
        }
    }
}

int fl_out_open(fl_out *out, const char *path, int gzip, fl_err *err)
{
    int fd = STDOUT_FILENO, direct;
    *out = (fl_out){0};
    if (strcmp(path, "-") != 0) {
        if (resolve_names(out, path, &direct, err)) return -1;
        if (direct) fd = open(out->path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
        else fd = open_locked(out, 1, err);
        if (fd >= 0 && !direct && ftruncate(fd, 0)) {
            fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
            close(fd);
            goto fail;
        }
        if (fd < 0) {
            if (direct) fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
            free(out->tmp); /* tmp belongs to another writer or does not exist */
            out->tmp = NULL;
            goto fail;
        }
    } else if ((fcntl(fd, F_GETFL) & O_ACCMODE) == O_RDONLY) {
        return fl_fail(err, FL_SYSTEM, "<stdout>: %s", strerror(EBADF));
    }
    if (open_stream(out, fd, gzip, err) == 0) return 0;
fail:
    fl_out_abort(out);
    return -1;
}

/* A rename is durable only when the folder is on disk. */
static void sync_folder(const char *path)
{
    char *folder = strdup(path), *slash = folder ? strrchr(folder, '/') : NULL;
    if (slash) slash[slash == folder] = '\0';
    const int fd = folder ? open(slash ? folder : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC) : -1;
    if (fd >= 0) {
        fsync(fd); /* file systems that cannot sync a folder give no stronger guarantee */
        close(fd);
    }
    free(folder);
}

/* Reports a failed write; why is errno, or 0 if unknown. */
static int report_write_error(const fl_out *out, int why, fl_err *err)
{
    const int kept = out->keep_part && out->tmp;
    return fl_fail(err, FL_SYSTEM, "%s: %s%s%s", out->path ? out->path : "<stdout>",
                   why ? strerror(why) : "could not write all of it",
                   kept ? "; what was written until then is kept in " : "", kept ? out->tmp : "");
}

/* errno of an earlier write still describes the stream's error; any other errno does not. */
static int flush_stream(fl_out *out)
{
    if (!ferror(out->f)) errno = 0;
    return fflush(out->f) != 0 || ferror(out->f) ? -1 : 0;
}

int fl_out_flush(fl_out *out, fl_err *err)
{
    return flush_stream(out) ? report_write_error(out, errno, err) : 0;
}

/* Truncates the file after its last complete line. */
static void truncate_to_line(int fd)
{
    char last[4096];
    int64_t at = lseek(fd, 0, SEEK_END);
    while (at > 0) {
        const int64_t n = at < (int64_t)sizeof last ? at : (int64_t)sizeof last;
        int64_t k = n;
        if (pread(fd, last, (size_t)n, at - n) != n) return;
        while (k > 0 && last[k - 1] != '\n') k--;
        at -= n - k;
        if (k > 0) break;
    }
    if (at >= 0 && ftruncate(fd, at)) return; /* on failure the file stays as it is */
}

/* Writes all buffered data to disk.  Returns 0, or -1 with errno. */
static int flush_to_disk(fl_out *out)
{
    if (flush_stream(out)) return -1;
    if (out->gz && end_member(out->gz)) return -1;
    return !out->path || fsync(fd_of(out)) == 0 || errno == EINVAL || errno == EROFS ? 0 : -1;
}

int fl_out_close(fl_out *out, fl_err *err)
{
    const int plain = !out->gz;
    if (!out->f) return 0;
    int bad = flush_to_disk(out) != 0, why = errno;
    const int lock_fd = out->tmp ? dup(fd_of(out)) : -1; /* lock until the rename */
    gzip_writer *z = out->gz;
    if (out->f != stdout && fclose(out->f) != 0 && !bad) bad = 1, why = errno;
    out->f = NULL;
    if (z) { /* closes a member whose end failed */
        end_member(z);
        if (z->fd != STDOUT_FILENO && close(z->fd) != 0 && !bad) bad = 1, why = errno;
        free(z);
        out->gz = NULL;
    }
    if (!bad && out->tmp && rename(out->tmp, out->path) != 0) bad = 1, why = errno;
    if (bad && out->tmp && !out->keep_part) unlink(out->tmp);
    else if (bad && plain && lock_fd >= 0) truncate_to_line(lock_fd);
    if (lock_fd >= 0) close(lock_fd);
    if (bad) report_write_error(out, why, err);
    else if (out->tmp) sync_folder(out->path);
    free(out->tmp); /* renamed, kept, or removed: no longer to be removed here */
    out->tmp = NULL;
    fl_out_abort(out);
    return bad ? -1 : 0;
}

void fl_out_abort(fl_out *out)
{
    gzip_writer *z = out->gz;
    if (out->tmp && !out->keep_part) unlink(out->tmp); /* while the lock is held */
    if (out->f && out->f != stdout) fclose(out->f);
    if (z) {
        end_member(z);
        if (z->fd != STDOUT_FILENO) close(z->fd);
        free(z);
    }
    free(out->tmp);
    free(out->path);
    *out = (fl_out){0};
}

/* --- checkpoint marks -------------------------------------------------------------------------- */

/* Hash of the last bytes before `at`; 0 if they cannot be read. */
static uint64_t hash_of_tail(int fd, int64_t at)
{
    unsigned char last[FL_FILE_MARK_TAIL] = {0};
    const int64_t n = at < FL_FILE_MARK_TAIL ? at : FL_FILE_MARK_TAIL;
    char self[40];
    int64_t got = pread(fd, last, (size_t)n, at - n);
    if (got < 0) { /* write-only, as the shell opens standard output */
        snprintf(self, sizeof self, "/proc/self/fd/%d", fd);
        const int again = open(self, O_RDONLY | O_CLOEXEC);
        if (again < 0) return 0;
        got = pread(again, last, (size_t)n, at - n);
        close(again);
    }
    return got == n ? fl_hash(FL_HASH_START, last, n) : 0;
}

int fl_out_mark(fl_out *out, fl_file_mark *mark, fl_err *err)
{
    struct stat st;
    *mark = (fl_file_mark){-1, 0};
    if (flush_to_disk(out)) return report_write_error(out, errno, err);
    const int fd = fd_of(out);
    if (fstat(fd, &st) || !S_ISREG(st.st_mode)) return 0;
    mark->offset = lseek(fd, 0, SEEK_CUR);
    if (mark->offset >= 0) mark->tail_hash = hash_of_tail(fd, mark->offset);
    out->keep_part = 1;
    return 0;
}

static int matches_mark(int fd, const fl_file_mark *mark)
{
    struct stat st;
    if (fstat(fd, &st) || !S_ISREG(st.st_mode) || st.st_size < mark->offset) return 0;
    return mark->tail_hash == 0 || hash_of_tail(fd, mark->offset) == mark->tail_hash;
}

/* Which of the two names holds the marked file: 0 tmp, 1 path, -1 none. */
static int find_marked_file(const fl_out *out, const fl_file_mark *mark)
{
    const char *const name[2] = {out->tmp, out->path};
    for (int k = 0; k < 2; k++) {
        const int fd = open(name[k], O_RDONLY | O_CLOEXEC);
        const int good = fd >= 0 && matches_mark(fd, mark);
        if (fd >= 0) close(fd);
        if (good) return k;
    }
    return -1;
}

static int report_no_marked_file(const fl_out *out, fl_err *err)
{
    return fl_fail(err, FL_INPUT, "%s: neither it nor %s begins with what was written before the checkpoint",
                   out->path, out->tmp);
}

int fl_out_check_mark(const char *path, const fl_file_mark *mark, fl_err *err)
{
    fl_out out;
    int direct, rc = 0;
    if (strcmp(path, "-") == 0 || mark->offset < 0) return 0;
    if (resolve_names(&out, path, &direct, err)) return -1;
    if (!direct && find_marked_file(&out, mark) < 0) rc = report_no_marked_file(&out, err);
    out.keep_part = 1;
    fl_out_abort(&out);
    return rc;
}

int fl_out_resume(fl_out *out, const char *path, int gzip, const fl_file_mark *mark, int *fresh, fl_err *err)
{
    int fd = STDOUT_FILENO, direct = 0;
    *fresh = 1;
    *out = (fl_out){0};
    if (mark->offset < 0) return fl_out_open(out, path, gzip, err);
    if (strcmp(path, "-") == 0) {
        if (mark->offset == 0 || !matches_mark(fd, mark)) return fl_out_open(out, path, gzip, err);
    } else {
        if (resolve_names(out, path, &direct, err)) return -1;
        if (direct) {
            fl_out_abort(out);
            return fl_out_open(out, path, gzip, err);
        }
        const int which = find_marked_file(out, mark);
        out->keep_part = 1;
        if (which < 0) report_no_marked_file(out, err);
        if (which < 0) goto fail;
        if (which == 1) { /* the file at tmp may belong to a running program */
            const int other = open_locked(out, 1, err);
            if (other < 0) goto fail;
            const int bad = rename(out->path, out->tmp);
            close(other);
            if (bad) goto system;
        }
        fd = open_locked(out, 0, err);
        if (fd < 0) goto fail;
    }
    if (ftruncate(fd, mark->offset) || lseek(fd, mark->offset, SEEK_SET) < 0) {
        fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
        if (fd != STDOUT_FILENO) close(fd);
        goto fail;
    }
    *fresh = 0;
    if (open_stream(out, fd, gzip, err) == 0) return 0;
    goto fail;
system:
    fl_fail(err, FL_SYSTEM, "%s: %s", path, strerror(errno));
fail:
    fl_out_abort(out);
    return -1;
}
