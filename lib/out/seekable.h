/* SPDX-License-Identifier: GPL-3.0-or-later */
/* seekable.h -- a file, plain or gzip, or standard input, read once from its start and then at any place.
 *
 * A plain file is read where it lies.  Standard input is copied to a file without a name in TMPDIR.  Of a
 * gzip file the first pass keeps, every 16 MiB of its text, a block boundary with the 32 KiB of text
 * before it, from which inflating can start; reading at a place inflates at most 16 MiB.  Several gzip
 * members are one text. Memory: 32 KiB for each 16 MiB of text. Source: M. Adler, zlib/examples/zran.c. */
#ifndef FL_OUT_SEEKABLE_H
#define FL_OUT_SEEKABLE_H
#include <stdint.h>
#include "base/err.h"

typedef struct fl_seekable fl_seekable;

/* "-" is standard input.  NULL with FL_INPUT (missing, a folder, unreadable) or FL_SYSTEM. */
fl_seekable *fl_seekable_open(const char *path, fl_err *err);

/* The first pass: the next bytes, up to n.  The number read; 0 at the end; -1 with FL_INPUT or FL_SYSTEM.
 * A gzip file that is cut off or damaged ends where its text ends; fl_seekable_is_cut() then says so.  At the
 * end of a plain file that still grows, a later call goes on. */
int64_t fl_seekable_next(fl_seekable *s, void *buf, int64_t n, fl_err *err);

/* Passes over n bytes.  0, or -1 as above. */
int fl_seekable_skip(fl_seekable *s, int64_t n, fl_err *err);

/* Sets the first pass of a plain file back to `offset`, to read what has been added since. */
void fl_seekable_set_back(fl_seekable *s, int64_t offset);

/* True if the first pass met the end of a gzip file that is cut off or damaged. */
int fl_seekable_is_cut(const fl_seekable *s);

/* n bytes from `offset` of the text, which the first pass has passed.  0, or -1 with FL_INPUT (the file has
 * become shorter or other) or FL_SYSTEM. */
int fl_seekable_read(fl_seekable *s, int64_t offset, void *buf, int64_t n, fl_err *err);

/* The name for messages. */
const char *fl_seekable_name(const fl_seekable *s);

void fl_seekable_close(fl_seekable *s); /* NULL is accepted */

#endif
