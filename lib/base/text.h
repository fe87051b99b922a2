/* SPDX-License-Identifier: GPL-3.0-or-later */
/* text.h -- rows of a text file: kind and version, history, comments, fields; errors name file and line. */
#ifndef FL_BASE_TEXT_H
#define FL_BASE_TEXT_H
#include <stdint.h>
#include "base/err.h"
#include "base/stream.h"

enum { FL_TEXT_LINE_MAX = 1 << 20 }; /* a longer line is refused: the file is of another kind */

typedef struct {
    fl_in *in;
    char *chunk;                  /* data read and not yet split */
    int64_t chunk_len, chunk_pos; /* bytes in chunk, and position */
    int64_t nul_free;             /* no nul byte before this position of chunk */
    char *line;                   /* the current line, split in place; in chunk or in joined */
    char *joined;                 /* a line that spans two chunks */
    int32_t len, joined_cap;
    int64_t line_number; /* line number, from 1 */
    char **field;        /* fields of the current row */
    int32_t n, next, field_cap;
    char *history; /* the "#by ..." and "#stopped ..." lines, each with its newline; NULL if none */
    int32_t history_len, history_cap;
    char *run_lines; /* the "#set ...", "#part ..." and "#report ..." lines of a run, likewise */
    int32_t run_lines_len, run_lines_cap;
    char kind[32]; /* kind and version, set by fl_text_magic() */
    int version;
} fl_text;

/* Opens for reading; "-" is standard input, gzip is unpacked.  0, or -1 with err. */
int fl_text_open(fl_text *t, const char *path, fl_err *err);

/* Same for n bytes in memory; data and name stay the caller's. */
int fl_text_open_bytes(fl_text *t, const char *name, const void *data, int64_t n, fl_err *err);

/* Reads line 1, which must be "#KIND VERSION" with VERSION in 1 .. newest; kind NULL accepts any kind.
 * Otherwise FL_INPUT; the message names a newer version or another kind. */
int fl_text_magic(fl_text *t, const char *kind, int newest, fl_err *err);

/* Reads the next line without its end (\n or \r\n) and byte order mark, comments and blank lines included.
 * 1, or 0 at the end of the file, or -1 with err (too long, a nul byte, read error). */
int fl_text_line(fl_text *t, fl_err *err);

/* Splits the line just read into field[0 .. n) at blanks and tabs, up to a "#", and sets next = 0.
 * Lines of the history and of the run are kept.  1, or 0 if the line is empty, or -1 with err. */
int fl_text_split(fl_text *t, fl_err *err);

/* Reads the next row: skips blank lines and comments (keeping history and lines of the run), splits at
 * blanks and tabs into field[0 .. n), and sets next = 0.  1, 0 or -1 as above. */
int fl_text_row(fl_text *t, fl_err *err);

/* Return the next field of the row.  `what` names it in the message if it is missing or invalid. */
int fl_text_word(fl_text *t, const char *what, const char **word, fl_err *err);
/* Reads the next row, which has to begin with that word, and the word. */
int fl_text_row_of(fl_text *t, const char *word, fl_err *err);
int fl_text_f64(fl_text *t, const char *what, double *x, fl_err *err);
int fl_text_i32(fl_text *t, const char *what, int32_t lo, int32_t hi, int32_t *x, fl_err *err);
/* Fails if the row has unread fields. */
int fl_text_no_more(fl_text *t, fl_err *err);

/* Fails with "file:line: " before the message.  Returns -1. */
int fl_text_fail(const fl_text *t, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* Accepts a zeroed struct and leaves one. */
void fl_text_close(fl_text *t);

/* The entry of list[0 .. n) with the smallest edit distance to word, for "unknown key X, nearest is Y".
 * Entries that contain word whole, as "softening" contains "soft", are preferred.  NULL if n = 0. */
const char *fl_text_nearest(const char *word, const char *const *list, int n);

#endif
