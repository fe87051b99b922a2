/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_line.h -- lines of an Abaqus or CalculiX deck: keyword lines with parameters, data lines with commas.
 *
 *     *WORD, KEY=VALUE, FLAG,      case and blanks in WORD and KEY do not matter; a final comma continues
 *     KEY="a, b"                   the line; quotes may contain commas
 *     ** a comment, anywhere
 *     1, 2.5, , 4                  data: a blank field is 0 */
#ifndef FL_MESH_INP_LINE_H
#define FL_MESH_INP_LINE_H
#include "geom/vec3.h"
#include "mesh/deck_lines.h"

enum {
    FL_INP_FIELDS = 64, /* per data line; Abaqus reads up to sixteen */
    FL_INP_PARAMS = 24, /* per keyword line; further ones are ignored */
    FL_INP_WORD = 48    /* bytes of a keyword; a longer one is truncated */
};

typedef struct {
    fl_deck deck;
    char *text; /* of the keyword line, split in place */
    int32_t text_cap;
    char word[FL_INP_WORD]; /* "BEAMSECTION" */
    char *key[FL_INP_PARAMS], *value[FL_INP_PARAMS];
    int params;
    char *field[FL_INP_FIELDS]; /* of the data line, without surrounding blanks */
    int fields, more;           /* more: the line ends with a comma */
} fl_inp_line;

/* Advance to the next line that is no comment; *INCLUDE is followed wherever it stands.  Returns 1 at a
 * keyword line, which fl_inp_split_keyword() splits, 2 at a data line, 0 at the end, or -1 with FL_INPUT or
 * FL_SYSTEM. */
int fl_inp_next(fl_inp_line *r, fl_err *err);
int fl_inp_split_keyword(fl_inp_line *r, fl_err *err);

/* Advance to the next data line and split it.  Returns 1; 0 at the end or before a keyword line, which
 * fl_inp_next() then returns; or -1. */
int fl_inp_next_data(fl_inp_line *r, fl_err *err);

/* Value of a key (upper case) of the keyword line: NULL if it is absent, "" for a flag.  True if it has that
 * value (upper case, no blanks).  A value that must be present, or NULL with FL_INPUT.  Valid until the next
 * line is read. */
const char *fl_inp_param(const fl_inp_line *r, const char *key);
int fl_inp_param_is(const fl_inp_line *r, const char *key, const char *value);
const char *fl_inp_required(const fl_inp_line *r, const char *key, fl_err *err);

/* Field k of the data line, counted from 0, as a number; fields k to k + 2 as a point; field k as an integer
 * (`missing` if blank); as the number of a node or element (1 or more).  0, or -1 with FL_INPUT. */
int fl_inp_real(const fl_inp_line *r, int k, double *x, fl_err *err);
int fl_inp_point(const fl_inp_line *r, int k, fl_vec3 *x, fl_err *err);
int fl_inp_integer(const fl_inp_line *r, int k, int64_t missing, int64_t *n, fl_err *err);
int fl_inp_id(const fl_inp_line *r, int k, int64_t *id, fl_err *err);

/* Fail with file and line before what and more, a word of the deck.  Returns -1. */
int fl_inp_fail(const fl_inp_line *r, fl_err *err, const char *what, const char *more);

void fl_inp_line_free(fl_inp_line *r); /* accepts a zeroed struct, leaves one */

#endif
