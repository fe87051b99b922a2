/* SPDX-License-Identifier: GPL-3.0-or-later */
/* deck_lines.h -- the lines of a deck and of the files it includes, and what decks call a number. */
#ifndef FL_MESH_DECK_LINES_H
#define FL_MESH_DECK_LINES_H
#include <stdint.h>
#include "mesh/bytes.h"
#include "mesh/elements.h"

enum {
    FL_DECK_DEPTH = 16,    /* files that include one another */
    FL_DECK_FILES = 10000, /* files that are included in all: two that include one another do not go on */
};

typedef struct {
    fl_elements *e; /* borrowed; its file and line follow the lines */
    fl_bytes *base; /* borrowed: the deck itself */
    fl_bytes included[FL_DECK_DEPTH];
    int32_t file[FL_DECK_DEPTH + 1]; /* of e->files, by depth */
    int depth, includes;
    char *line; /* the current one, [len] and a zero byte */
    int32_t len;
    int unread;                       /* it is to come once more, */
    int32_t unread_file, unread_line; /* from there */
} fl_deck;

void fl_deck_start(fl_deck *d, fl_elements *e, fl_bytes *base);

/* Next line, without its end (\n, \r\n or \r) and blanks behind it, blank ones too; at the end of an included
 * file the lines of the including one go on.  1, 0 at the end, -1 with FL_INPUT (a zero byte) in err. */
int fl_deck_line(fl_deck *d, fl_err *err);

/* Let the current line be the next one too. */
void fl_deck_unread(fl_deck *d);

/* Go on with the lines of a file, named relative to the deck.  -1 with FL_INPUT (missing, one that is being
 * read, more than FL_DECK_DEPTH deep or FL_DECK_FILES in all) or FL_SYSTEM. */
int fl_deck_include(fl_deck *d, const char *path, fl_err *err);

/* Fail with file and line.  Returns -1. */
int fl_deck_fail(const fl_deck *d, fl_err *err, const char *fmt, ...) __attribute__((format(printf, 3, 4)));

/* All of s as a finite number: as elsewhere, or with D for E, or with the E left out ("1.5-3" is 0.0015).
 * 0, or -1. */
int fl_deck_real(const char *s, double *x);

/* All of s as a whole number of up to 18 digits: 0, or -1. */
int fl_deck_integer(const char *s, int64_t *x);

/* s without blanks at both ends, in place. */
char *fl_deck_trim(char *s);

void fl_deck_free(fl_deck *d); /* accepts a zeroed struct, leaves one */

#endif
