/* SPDX-License-Identifier: GPL-3.0-or-later */
/* restart.h -- the checkpoint file: named texts and a hash over all of them.  Format: checkpoint(5). */
#ifndef FL_OUT_RESTART_H
#define FL_OUT_RESTART_H
#include <stdint.h>
#include "base/err.h"
#include "base/text.h"

/* Raise the version, here alone, with every change of the content of the parts: a row or member added or
 * removed, another order, another meaning.  test_snapshot.c has the layout that belongs to it. */
enum { FL_RESTART_VERSION = 19, FL_RESTART_PARTS = 12 };

typedef struct {
    char name[16];
    const char *text; /* borrowed when written; inside fl_restart.data when read */
    int64_t n;
} fl_restart_part;

typedef struct {
    char *data; /* the whole file, unpacked; owned */
    int32_t cap;
    char *history;    /* the lines "#by ..."; owned */
    const char *path; /* borrowed */
    int32_t version;
    fl_restart_part part[FL_RESTART_PARTS]; /* in the order of the file */
    int parts;
} fl_restart;

/* Write path, compressed:
 *     #checkpoint VERSION        FL_RESTART_VERSION
 *     #by ...                    history, complete lines
 *     part NAME BYTES            and so many bytes, for each part
 *     end HASH                   fl_hash() of all bytes before, 16 hexadecimal digits
 * The file gets its name when it is complete on the disk; an older file of that name stays until then.
 * -1 with FL_SYSTEM. */
int fl_restart_write(const char *path, const char *history, const fl_restart_part *part, int parts,
                     fl_err *err);

/* Read and check it.  -1 with FL_INPUT (not a checkpoint, a newer version, cut short, damaged), or FL_SYSTEM;
 * r is then untouched. */
int fl_restart_read(fl_restart *r, const char *path, fl_err *err);
void fl_restart_free(fl_restart *r);

/* Check that the parts are of this version.  The container is read in any version; a state has exactly the
 * members of its version, so an older one is rejected.  -1 with FL_INPUT. */
int fl_restart_current(const fl_restart *r, fl_err *err);

/* Open a part by name as a text, which the caller closes; messages name the checkpoint.  -1 with FL_INPUT if
 * there is no such part, or FL_SYSTEM. */
int fl_restart_open(const fl_restart *r, const char *name, fl_text *text, fl_err *err);

/* The part of that name, or NULL. */
const fl_restart_part *fl_restart_find(const fl_restart *r, const char *name);

#endif
