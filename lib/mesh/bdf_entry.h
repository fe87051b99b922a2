/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bdf_entry.h -- Nastran bulk data, read entry by entry and split into fields. */
#ifndef FL_MESH_BDF_ENTRY_H
#define FL_MESH_BDF_ENTRY_H
#include "geom/vec3.h"
#include "mesh/deck_lines.h"

enum {
    FL_BDF_FIELDS = 48, /* per entry; further fields are ignored, the entries that are read have at most 24 */
    FL_BDF_NAME = 9
};

typedef struct {
    fl_deck deck;
    char name[FL_BDF_NAME]; /* upper case, without the star of large fields */
    int32_t file, line;     /* position of its first line */
    int fields;             /* rounded up to whole rows of eight */
    char *text;             /* of the fields, each ended by a zero byte */
    int32_t text_len, text_cap;
    int32_t at[FL_BDF_FIELDS]; /* offsets into text */
    int bulk;                  /* BEGIN BULK has been read */
    int frame;                 /* split also what frame_bdf.h reads */
    int missing;               /* files that could not be included before BEGIN BULK */
    fl_err first_missing;      /* why, of the first */
    /* called with the text behind $ of each comment line; may be NULL */
    int (*comment)(void *context, const char *text, fl_err *err);
    void *context;
} fl_bdf_entry;

/* Advance to the next entry.  INCLUDE is followed, ENDDATA ends the deck.  Files that cannot be included are
 * counted before BEGIN BULK, where they hold commands, and an error behind it, or where it never comes.
 * Returns 1, 0 at the end, or -1 with FL_INPUT or FL_SYSTEM. */
int fl_bdf_next(fl_bdf_entry *r, fl_err *err);

/* Field k, counted from 0 behind the name, without surrounding blanks; "" if there is none. */
const char *fl_bdf_field(const fl_bdf_entry *r, int k);

/* Field k as a number, 0 if blank; fields k to k + 2 as a point; field k as an integer, `blank` if blank;
 * field k as an identifier of 1 or more.  0, or -1 with FL_INPUT. */
int fl_bdf_real(const fl_bdf_entry *r, int k, double *x, fl_err *err);
int fl_bdf_point(const fl_bdf_entry *r, int k, fl_vec3 *x, fl_err *err);
int fl_bdf_integer(const fl_bdf_entry *r, int k, int64_t blank, int64_t *n, fl_err *err);
int fl_bdf_id(const fl_bdf_entry *r, int k, int64_t *n, fl_err *err);

/* Fail with file and line of the entry.  Returns -1. */
int fl_bdf_fail(const fl_bdf_entry *r, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));

void fl_bdf_entry_free(fl_bdf_entry *r); /* accepts a zeroed struct, leaves one */

#endif
