/* SPDX-License-Identifier: GPL-3.0-or-later */
/* inp_line.h -- lines of a deck of Abaqus or CalculiX: keyword lines with parameters, data lines with commas.
 *
 *     *WORD, KEY=VALUE, FLAG,      letters of either case and blanks in WORD and KEY do not matter; a comma
 * at KEY="a, b"                   the end goes on in the next line; quotes hold commas
 *     ** a comment, anywhere
 *     1, 2.5, , 4                  data: what is blank is 0 */
#ifndef FL_MESH_INP_LINE_H
#define FL_MESH_INP_LINE_H
#include "geom/vec3.h"
#include "mesh/deck_lines.h"

enum {
    FL_INP_FIELDS = 64, /* on a data line; sixteen are the most that Abaqus reads */
    FL_INP_PARAMS = 24, /* on a keyword line; more are passed over */
    FL_INP_WORD = 48    /* bytes of a keyword, a longer one is cut */
};

typedef struct {
    fl_deck deck;
    char *text; /* of the keyword line, cut up */
    int32_t text_cap;
    char word[FL_INP_WORD]; /* "BEAMSECTION" */
    char *key[FL_INP_PARAMS], *value[FL_INP_PARAMS];
    int params;
    char *field[FL_INP_FIELDS]; /* of the data line, without blanks at the ends */
    int fields, more;           /* more: the line ends with a comma */
} fl_inp_line;

/* Step to the next line that is no comment; *INCLUDE is followed wherever it stands.  1 at a keyword line,
 * which fl_inp_split_keyword() cuts up, 2 at a data line, 0 at the end, -1 with FL_INPUT or FL_SYSTEM. */
int fl_inp_next(fl_inp_line *r, fl_err *err);
int fl_inp_split_keyword(fl_inp_line *r, fl_err *err);

/* Step to the next data line and cut it up: 1; 0 where a keyword comes, which fl_inp_next() will give, or the
 * end; -1. */
int fl_inp_next_data(fl_inp_line *r, fl_err *err);

/* What the keyword line says under a key in capitals: NULL where it does not, "" for a flag; is it that value
 * (in capitals, without blanks)?  What it must say, NULL with FL_INPUT.  Good until the next line is read. */
const char *fl_inp_param(const fl_inp_line *r, const char *key);
int fl_inp_param_is(const fl_inp_line *r, const char *key, const char *value);
const char *fl_inp_required(const fl_inp_line *r, const char *key, fl_err *err);

/* Field k of the data line, from 0: a number, three of them, a whole number (`missing` where it is blank),
 * the number of a node or element (1 or more).  0, or -1 with FL_INPUT. */
int fl_inp_real(const fl_inp_line *r, int k, double *x, fl_err *err);
int fl_inp_point(const fl_inp_line *r, int k, fl_vec3 *x, fl_err *err);
int fl_inp_integer(const fl_inp_line *r, int k, int64_t missing, int64_t *n, fl_err *err);
int fl_inp_id(const fl_inp_line *r, int k, int64_t *id, fl_err *err);

/* Fail with file and line before what and more, a word of the deck.  Returns -1. */
int fl_inp_fail(const fl_inp_line *r, fl_err *err, const char *what, const char *more);

void fl_inp_line_free(fl_inp_line *r); /* accepts a zeroed struct, leaves one */

#endif
