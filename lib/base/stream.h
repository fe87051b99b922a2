/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stream.h -- bytes in from a file, standard input or gzip of either; bytes out to a file or standard
 * output.  A file that is written carries its final name only when it is complete. */
#ifndef FL_BASE_STREAM_H
#define FL_BASE_STREAM_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"

typedef struct fl_in fl_in;

/* Open a file, or standard input for "-".  Gzip is recognised by its first two bytes.
 * NULL with FL_INPUT (missing, a folder, unreadable) or FL_SYSTEM in err. */
fl_in *fl_in_open(const char *path, fl_err *err);

/* Read up to n bytes; returns the number read, 0 at the end, -1 with FL_INPUT in err (damaged gzip, read
 * error). A short count is not the end: data are handed over as they come down a pipe. */
int64_t fl_in_read(fl_in *in, void *buf, int64_t n, fl_err *err);

/* A file that ends is read again, as something else may still be writing it, until it has not grown for so
 * many seconds; 0, as at first, takes its end for the end. */
void fl_in_patience(fl_in *in, double seconds);

/* The name to put in messages: the path, or "<stdin>". */
const char *fl_in_name(const fl_in *in);
void fl_in_close(fl_in *in); /* NULL is accepted */

typedef struct {
    FILE *f;          /* write here; NULL when closed */
    char *path, *tmp; /* NULL for standard output; tmp alone NULL for a device or a pipe */
    void *gz;         /* the compressor, when asked for */
} fl_out;

/* Open path for writing ("-" is standard output); gzip compresses.  A link is followed, and a device or a
 * pipe (/dev/null, a fifo) is written to directly.  FL_SYSTEM in err on failure. */
int fl_out_open(fl_out *out, const char *path, int gzip, fl_err *err);

/* Flush, sync, and give the file its final name.  -1 with FL_SYSTEM in err when anything written was lost;
 * then no file carries the final name (an older one keeps it). */
int fl_out_close(fl_out *out, fl_err *err);

/* Drop what was written: the final name is not touched.  Accepts a zeroed or closed struct. */
void fl_out_abort(fl_out *out);

#endif
