/* SPDX-License-Identifier: GPL-3.0-or-later */
/* deck_lines.h -- lines of a text deck and of the files it includes, and the numbers such decks contain. */
#ifndef FL_MESH_DECK_LINES_H
#define FL_MESH_DECK_LINES_H
#include <stdint.h>
#include "mesh/bytes.h"
#include "mesh/elements.h"

enum {
    FL_DECK_DEPTH = 16,    /* nesting of included files */
    FL_DECK_FILES = 10000, /* included files in all: two files that include each other must end */
};

typedef struct {
    fl_elements *e; /* borrowed; its file and line follow the current line */
    fl_bytes *base; /* borrowed: the deck itself */
    fl_bytes included[FL_DECK_DEPTH];
    int32_t file[FL_DECK_DEPTH + 1]; /* indices in e->files, by depth */
    int depth, includes;
    char *line; /* the current line, [len] and a zero byte */
    int32_t len;
    int unread;                       /* the current line is to be returned again */
    int32_t unread_file, unread_line; /* its position */
} fl_deck;

void fl_deck_start(fl_deck *d, fl_elements *e, fl_bytes *base);

/* Advance to the next line, blank lines included, without its end (\n, \r\n or \r) and trailing blanks.  At
 * the end of an included file the including file continues.  Returns 1, 0 at the end, or -1 with FL_INPUT (a
 * zero byte). */
int fl_deck_line(fl_deck *d, fl_err *err);

/* Return the current line once more from the next call of fl_deck_line(). */
void fl_deck_unread(fl_deck *d);

/* Continue with the lines of another file, named relative to the deck.  -1 with FL_INPUT (missing, already
 * open, more than FL_DECK_DEPTH deep or FL_DECK_FILES in all) or FL_SYSTEM. */
int fl_deck_include(fl_deck *d, const char *path, fl_err *err);

/* Fail with file and line.  Returns -1. */
int fl_deck_fail(const fl_deck *d, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* Parse all of s as a finite number.  D may replace E, and E may be left out ("1.5-3" is 0.0015).  0, or -1.
 */
int fl_deck_real(const char *s, double *x);

/* Parse all of s as an integer of up to 18 digits: 0, or -1. */
int fl_deck_integer(const char *s, int64_t *x);

/* s without blanks at both ends, in place. */
char *fl_deck_trim(char *s);

void fl_deck_free(fl_deck *d); /* accepts a zeroed struct, leaves one */

#endif
