/* SPDX-License-Identifier: GPL-3.0-or-later */
/* restart.h -- the checkpoint file: texts under names, held together by a hash.  Format: checkpoint(5). */
#ifndef FL_OUT_RESTART_H
#define FL_OUT_RESTART_H
#include <stdint.h>
#include "base/err.h"
#include "base/text.h"

/* The number is raised, here alone, with every change of what the parts hold: a row or a member more, one
 * less, another order, another meaning.  test_snapshot has the layout that it stands for. */
enum { FL_RESTART_VERSION = 12, FL_RESTART_PARTS = 12 };

typedef struct {
    char name[16];
    const char *text; /* borrowed in what is written, inside data in what was read */
    int64_t n;
} fl_restart_part;

typedef struct {
    char *data; /* the whole file, unpacked; owned */
    int32_t cap;
    char *history;    /* the "#by ..." lines; owned */
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
 * It gets its name when all of it is on the disk; until then one that was there before keeps it.
 * -1 with FL_SYSTEM. */
int fl_restart_write(const char *path, const char *history, const fl_restart_part *part, int parts,
                     fl_err *err);

/* Read and check it.  -1 with FL_INPUT (not a checkpoint, a newer one, cut short, damaged), or FL_SYSTEM; r
 * is untouched then. */
int fl_restart_read(fl_restart *r, const char *path, fl_err *err);
void fl_restart_free(fl_restart *r);

/* Are its parts those of this version?  What holds them together is read whatever their version, but a state
 * has all that its program knew and nothing else, so that one from before is refused.  -1 with FL_INPUT. */
int fl_restart_current(const fl_restart *r, fl_err *err);

/* Open a part by name as a text, which the caller closes; messages tell the checkpoint's name.  -1 with
 * FL_INPUT when there is no such part, or FL_SYSTEM. */
int fl_restart_open(const fl_restart *r, const char *name, fl_text *text, fl_err *err);

/* The part itself; NULL when there is none. */
const fl_restart_part *fl_restart_find(const fl_restart *r, const char *name);

#endif
