/* SPDX-License-Identifier: GPL-3.0-or-later */
/* text.h -- the rows of a text file: kind and version, history, comments, fields, and complaints that
 * name file and line. */
#ifndef FL_BASE_TEXT_H
#define FL_BASE_TEXT_H
#include <stdint.h>
#include "base/err.h"
#include "base/stream.h"

enum { FL_TEXT_LINE_MAX = 1 << 20 }; /* a longer line is refused: the file is not one of ours */

typedef struct {
    fl_in *in;
    char *chunk;                  /* what was read and not yet split */
    int64_t chunk_len, chunk_pos; /* of chunk */
    int64_t nul_free;             /* no zero byte before this place of chunk */
    char *line;                   /* the current line, cut into fields in place; in chunk, or in own */
    char *joined;                 /* a line that lay in two chunks */
    int32_t len, joined_cap;
    int64_t line_number; /* of the line, from 1 */
    char **field;        /* fields of the current row */
    int32_t n, next, field_cap;
    char *history; /* the "#by ..." lines, each with its newline; NULL while there are none */
    int32_t history_len, history_cap;
    char kind[32]; /* both set by fl_text_magic() */
    int version;
} fl_text;

/* Open for reading; "-" is standard input, gzip is unpacked.  0, or -1 with err. */
int fl_text_open(fl_text *t, const char *path, fl_err *err);

/* The same from n bytes in memory; data and name stay the caller's. */
int fl_text_open_bytes(fl_text *t, const char *name, const void *data, int64_t n, fl_err *err);

/* Read line 1, which must be "#KIND VERSION" with VERSION in 1 .. newest; kind NULL takes any kind.
 * FL_INPUT in err otherwise; a newer file and a file of another kind are named as such. */
int fl_text_magic(fl_text *t, const char *kind, int newest, fl_err *err);

/* Next line whole, without its end (\n or \r\n) and byte order mark, comments and blank lines included.
 * 1, or 0 at the end of the file, or -1 with err (too long, a nul byte, read error). */
int fl_text_line(fl_text *t, fl_err *err);

/* Cut the line just read into field[0 .. n) at blanks and tabs, up to a "#", and set next = 0.  A "#by" line
 * joins the history.  1, or 0 when nothing is on it, or -1 with err. */
int fl_text_split(fl_text *t, fl_err *err);

/* Next row: skips blank lines and comments (gathering "#by" lines), cuts at blanks and tabs into
 * field[0 .. n), and sets next = 0.  1, 0 or -1 as above. */
int fl_text_row(fl_text *t, fl_err *err);

/* Take the next field of the row.  `what` names it in the complaint when it is missing or not a number. */
int fl_text_word(fl_text *t, const char *what, const char **word, fl_err *err);
int fl_text_f64(fl_text *t, const char *what, double *x, fl_err *err);
int fl_text_i32(fl_text *t, const char *what, int32_t lo, int32_t hi, int32_t *x, fl_err *err);
/* Complain about fields that nobody took. */
int fl_text_no_more(fl_text *t, fl_err *err);

/* Fail with "file:line: " before the sentence.  Returns -1. */
int fl_text_fail(const fl_text *t, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* Accepts a zeroed struct and leaves one. */
void fl_text_close(fl_text *t);

/* The entry of list[0 .. n) with the smallest edit distance to word, for "unknown key X, nearest is Y".
 * Where word stands whole in some of them, as "soft" in "softening", one of these.  NULL when n = 0. */
const char *fl_text_nearest(const char *word, const char *const *list, int n);

#endif
