/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bytes.h -- a mesh file read through a window.
 *
 * The head of the file decides its format.  The rest is read as rows of words, as lines or as bytes; bytes
 * that have been read are dropped from memory.  A reader may also load the whole file. */
#ifndef FL_MESH_BYTES_H
#define FL_MESH_BYTES_H
#include <stdint.h>
#include "base/err.h"
#include "base/stream.h"

enum { FL_MESH_NOTE = 4000 };

typedef struct {
    fl_in *in;
    char *data; /* [n] and a zero byte after them; rows are split in place */
    int32_t n, cap, pos;
    int32_t
        complete; /* a line that begins before this index of data ends in data, continuation lines included */
    int ended;    /* data holds the rest of the file */
    int64_t offset; /* in the file, of data[0] */
    int32_t line;   /* of the current row; 0 in binary data */
    char comment;   /* opens a comment, '\0' for none */
    int fortran;    /* fl_bytes_real() takes 1D5 and 1.5-3 too */
    char **field;   /* words of the current row */
    int32_t words, next, field_cap;
    char note[FL_MESH_NOTE]; /* remarks for the user, each with its newline */
} fl_bytes;

/* Open path ("-" is standard input; gzip is unpacked) and read its head of up to FL_BYTES_HEAD bytes.  A
 * UTF-8 byte order mark is dropped.  0, or -1 with FL_INPUT (missing, unreadable) or FL_SYSTEM. */
enum { FL_BYTES_HEAD = 1 << 22 };
int fl_bytes_open(fl_bytes *b, const char *path, fl_err *err);

/* Read the rest of the file into memory, for formats that need random access.  0, or -1 with FL_INPUT (larger
 * than 2 GiB, unreadable) or FL_SYSTEM. */
int fl_bytes_read_all(fl_bytes *b, fl_err *err);

/* True for a character that separates words within a line. */
static inline int fl_bytes_blank(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }

/* True if the head holds no zero byte. */
int fl_bytes_is_text(const fl_bytes *b);

/* For tests: size of the head and of the window in bytes; 0 restores the default. */
void fl_bytes_set_window(int32_t bytes);

/* Read n bytes.  *p points to them until the next call of any function of this module.  Returns 1, 0 if the
 * file ends before, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_bytes_read(fl_bytes *b, int32_t n, const unsigned char **p, fl_err *err);

/* Look at the next n bytes without reading them; fewer at the end of the file.  Returns their number, or -1.
 */
int32_t fl_bytes_peek(fl_bytes *b, int32_t n, const char **p, fl_err *err);

/* Skip n bytes: 1, 0 if the file ends before, -1. */
int fl_bytes_skip(fl_bytes *b, int64_t n, fl_err *err);

/* Skip to the next line that begins with mark, followed by a blank, a line end or the end of the file.  In
 * binary data, where b->line is 0, the mark may stand anywhere: some writers leave out the line end behind
 * numbers.
 * Elsewhere lines are counted.  Returns 1, 0 if there is none, -1. */
int fl_bytes_seek(fl_bytes *b, const char *mark, fl_err *err);

/* Read the next line: *start points to it, a zero byte replaces its end (\n, \r\n or \r), *len is its length.
 * Returns 1, 0 at the end, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_bytes_line(fl_bytes *b, char **start, int32_t *len, fl_err *err);

/* Read the next row that has words; blank lines and comments are skipped.  A line ends with \n, \r\n or \r; a
 * backslash before the end joins the next line.  Returns 1, 0 at the end, or -1 with err (a zero byte, no
 * memory). */
int fl_bytes_row(fl_bytes *b, fl_err *err);

/* Read the next number, across blanks and line ends.  Returns 1, 0 at the end of the file, or -1 with
 * FL_INPUT if the next word is no number; with `any` set that word counts as 0.  Skipped lines are counted.
 */
int fl_bytes_real(fl_bytes *b, int any, double *x, fl_err *err);

/* Read the next word, of this row or a later one: 1, 0 at the end, -1 with err. */
int fl_bytes_word(fl_bytes *b, const char **word, fl_err *err);

/* Word k of the row, or the next word, as a finite number; `what` names it in messages.  0, or -1 with
 * FL_INPUT if it is missing, not a number, nan or infinite. */
int fl_bytes_f64_at(const fl_bytes *b, int32_t k, const char *what, double *x, fl_err *err);
int fl_bytes_f64(fl_bytes *b, const char *what, double *x, fl_err *err);

/* Fail with "file:line: ", or "file: " in binary data, before the message.  Returns -1. */
int fl_bytes_fail(const fl_bytes *b, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* Add a remark; one that does not fit is dropped. */
void fl_bytes_note(fl_bytes *b, const char *fmt, ...) __attribute__((format(printf, 2, 3)));

/* Offset of the next byte in the file. */
static inline int64_t fl_bytes_offset(const fl_bytes *b) { return b->offset + b->pos; }

void fl_bytes_free(fl_bytes *b); /* accepts a zeroed struct, leaves one */

#endif
