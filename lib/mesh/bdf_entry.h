/* SPDX-License-Identifier: GPL-3.0-or-later */
/* bdf_entry.h -- one entry of Nastran's bulk data at a time, from its lines to its fields. */
#ifndef FL_MESH_BDF_ENTRY_H
#define FL_MESH_BDF_ENTRY_H
#include "geom/vec3.h"
#include "mesh/deck_lines.h"

enum {
    FL_BDF_FIELDS = 48, /* of an entry; more are passed over: what is read has 24 at most */
    FL_BDF_NAME = 9
};

typedef struct {
    fl_deck deck;
    char name[FL_BDF_NAME]; /* in capitals, without the star of large fields */
    int32_t file, line;     /* where it starts */
    int fields;             /* in rows of eight */
    char *text;             /* of the fields */
    int32_t text_len, text_cap;
    int32_t at[FL_BDF_FIELDS]; /* places in text */
    /* for each comment line, its text behind the $; may be NULL */
    int (*comment)(void *context, const char *text, fl_err *err);
    void *context;
} fl_bdf_entry;

/* Step to the next entry; INCLUDE is followed, ENDDATA is the end.  1, 0, or -1 with FL_INPUT or FL_SYSTEM.
 */
int fl_bdf_next(fl_bdf_entry *r, fl_err *err);

/* Field k, from 0 behind the name, without blanks at its ends; "" for one that is not there. */
const char *fl_bdf_field(const fl_bdf_entry *r, int k);

/* It as a number, 0 where it is blank; three of them; as a whole number, `blank` where it is blank; as the
 * number of something, 1 or more.  0, or -1 with FL_INPUT. */
int fl_bdf_real(const fl_bdf_entry *r, int k, double *x, fl_err *err);
int fl_bdf_point(const fl_bdf_entry *r, int k, fl_vec3 *x, fl_err *err);
int fl_bdf_integer(const fl_bdf_entry *r, int k, int64_t blank, int64_t *n, fl_err *err);
int fl_bdf_id(const fl_bdf_entry *r, int k, int64_t *n, fl_err *err);

/* Fail with file and line of the entry.  Returns -1. */
int fl_bdf_fail(const fl_bdf_entry *r, fl_err *err, const char *fmt, ...)
    __attribute__((format(printf, 3, 4)));

void fl_bdf_entry_free(fl_bdf_entry *r); /* accepts a zeroed struct, leaves one */

#endif
