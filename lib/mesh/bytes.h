/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bytes.h -- a mesh file through a window: its head, to tell what it is, then as rows of words, as lines or
 * as bytes, while what has been read makes room for what comes; or all of it at once. */
#ifndef FL_MESH_BYTES_H
#define FL_MESH_BYTES_H
#include <stdint.h>
#include "base/err.h"
#include "base/stream.h"

enum { FL_MESH_NOTE = 4000 };

typedef struct {
    fl_in *in;
    char *data; /* [n], and a zero byte after them; rows are cut in place */
    int32_t n, cap, pos;
    int32_t complete; /* what begins before this place of data ends in data, continued lines too */
    int ended;        /* nothing comes behind data */
    int64_t offset;   /* bytes that have made room */
    int32_t line;     /* of the current row; 0 in binary data */
    char comment;     /* opens a comment, '\0' for none */
    char **field;     /* words of the current row */
    int32_t words, next, field_cap;
    char note[FL_MESH_NOTE]; /* remarks for the user, each with its newline */
} fl_bytes;

/* Open path ("-" is standard input, gzip is unpacked) and read its head, of up to FL_BYTES_HEAD bytes; a
 * UTF-8 byte order mark at its start is dropped. 0, or -1 with FL_INPUT (missing, unreadable) or FL_SYSTEM.
 */
enum { FL_BYTES_HEAD = 1 << 22 };
int fl_bytes_open(fl_bytes *b, const char *path, fl_err *err);

/* Read all that is left, behind what is there: for kinds of files that are looked at here and there.  0, or
 * -1 with FL_INPUT (larger than 2 GiB, unreadable) or FL_SYSTEM. */
int fl_bytes_read_all(fl_bytes *b, fl_err *err);

/* What words are parted by, but for ends of lines. */
static inline int fl_bytes_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }

/* True if the head holds no zero byte. */
int fl_bytes_is_text(const fl_bytes *b);

/* For tests: a head and a window of so many bytes; 0 for those above. */
void fl_bytes_set_window(int32_t bytes);

/* The next n bytes into *p, where they stay until the next call of anything here: 1, 0 when the file ends
 * before, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_bytes_read(fl_bytes *b, int32_t n, const unsigned char **p, fl_err *err);

/* The same bytes without stepping over them, fewer where the file ends before: how many, or -1. */
int32_t fl_bytes_peek(fl_bytes *b, int32_t n, const char **p, fl_err *err);

/* Step over n bytes: 1, 0 when the file ends before, -1. */
int fl_bytes_skip(fl_bytes *b, int64_t n, fl_err *err);

/* Step to the next line that begins with mark, which a blank, a line end or the end of the file follows; of
 * bytes that are no text it is one that a line end comes before.  Lines are counted where b->line is not 0.
 * 1, 0 when there is none, -1. */
int fl_bytes_seek(fl_bytes *b, const char *mark, fl_err *err);

/* The next line into *start, ended by a zero byte in place of its end (\n, \r\n or \r) and its length into
 * *len. 1, 0 at the end, -1 with FL_INPUT or FL_SYSTEM. */
int fl_bytes_line(fl_bytes *b, char **start, int32_t *len, fl_err *err);

/* Next row with words: skips blank ones and comments; \n, \r\n and \r end a line, and a backslash before the
 * end joins the next one on.  1, 0 at the end, -1 with err (a zero byte, no memory). */
int fl_bytes_row(fl_bytes *b, fl_err *err);

/* The next number, behind blanks and line ends: 1, 0 at the end of the file, or -1 with FL_INPUT when that is
 * no number; with `any` set it is then 0.  Lines that are stepped over are counted. */
int fl_bytes_real(fl_bytes *b, int any, double *x, fl_err *err);

/* Next word, of this row or of the next: 1, 0 at the end, -1 with err. */
int fl_bytes_word(fl_bytes *b, const char **word, fl_err *err);

/* Word k of the row, or the next word anywhere, as a finite number called `what` in the complaint.
 * 0, or -1 with FL_INPUT in err when it is missing, not a number, nan or infinite. */
int fl_bytes_f64_at(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err);
int fl_bytes_f64(fl_bytes *b, const char *what, double *x, fl_err *err);

/* Fail with "file:line: ", or "file: " in binary data, before the sentence.  Returns -1. */
int fl_bytes_fail(const fl_bytes *b, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* Add a remark; what does not fit is dropped. */
void fl_bytes_note(fl_bytes *b, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* How far into the file the next byte is. */
static inline int64_t fl_bytes_offset(const fl_bytes *b) { return b->offset + b->pos; }

void fl_bytes_free(fl_bytes *b); /* accepts a zeroed struct, leaves one */

#endif
