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

/* The same from n bytes in memory, which stay the caller's, as does the name that messages tell. */
fl_in *fl_in_open_bytes(const char *name, const void *data, int64_t n, fl_err *err);

/* Read up to n bytes; returns the number read, 0 at the end, -1 with FL_INPUT in err (damaged gzip, read
 * error). A short count is not the end: data are handed over as they come down a pipe. */
int64_t fl_in_read(fl_in *in, void *buf, int64_t n, fl_err *err);

/* A file that ends is read again, as something else may still be writing it, until it has not grown for so
 * many seconds; 0, as at first, takes its end for the end. */
void fl_in_follow(fl_in *in, double seconds);

/* The name to put in messages: the path, or "<stdin>". */
const char *fl_in_name(const fl_in *in);
void fl_in_close(fl_in *in); /* NULL is accepted */

typedef struct {
    FILE *f;          /* write here; NULL when closed */
    char *path, *tmp; /* NULL for standard output; tmp alone NULL for a device or a pipe */
    void *gz;         /* the compressor, when asked for */
    int keep_part;    /* tmp stays when something fails: what is in it is good without the rest */
} fl_out;

/* A place in a file, from which another run of the program can go on writing it. */
typedef struct {
    int64_t offset; /* bytes before it; -1: what is written to has no places, as a pipe */
    uint64_t
        tail_hash; /* hash of the last bytes before it, at most FL_FILE_MARK_TAIL; 0: they cannot be read */
} fl_file_mark;
enum { FL_FILE_MARK_TAIL = 4096 };

/* Open path for writing ("-" is standard output); gzip compresses, 2 faster and less.  A link is followed,
 * and a device or a pipe (/dev/null, a fifo) is written to directly.  What is unfinished, PATH.part, is
 * locked, and a file that something else writes at the same time is refused and left alone.  FL_SYSTEM in err
 * on failure. */
int fl_out_open(fl_out *out, const char *path, int gzip, fl_err *err);

/* Hand what was written to the system, as at the end of a row.  -1 with FL_SYSTEM in err when that, or a
 * write before it, has failed; where the unfinished file is kept the sentence names it. */
int fl_out_flush(fl_out *out, fl_err *err);

/* PATH.part of the file that path leads to, to be freed; NULL where a device or a pipe is written to
 * directly, and where memory runs out. */
char *fl_out_part_path(const char *path);

/* Flush, sync, and give the file its final name, which is synced too.  -1 with FL_SYSTEM in err when anything
 * written was lost; then no file carries the final name (an older one keeps it), and what was written goes,
 * or where it is kept stays in PATH.part, up to the end of its last whole line. */
int fl_out_close(fl_out *out, fl_err *err);

/* Bring what was written to the disk and tell the place.  From here on the unfinished file is kept,
 * PATH.part, since a mark speaks of it.  What is compressed ends a member of the gzip file here and begins
 * another, so that the bytes after a mark do not depend on those before.  -1 with FL_SYSTEM. */
int fl_out_mark(fl_out *out, fl_file_mark *mark, fl_err *err);

/* Is there a file that a mark speaks of: PATH.part, or PATH itself when that run ended, long enough and with
 * the same bytes before the mark?  Nothing is changed.  0, or -1 with FL_INPUT.  A mark without a place, and
 * standard output, are always fine. */
int fl_out_check_mark(const char *path, const fl_file_mark *mark, fl_err *err);

/* Open it as fl_out_open() and go on at the mark; what lies behind is cut off.  Standard output is gone on
 * with when it is a file that the mark speaks of (the shell's >>).  *fresh becomes 1 when there is nothing to
 * go on with, and the output begins as a new one: a pipe, a device, another file at standard output.  -1 with
 * FL_INPUT or FL_SYSTEM. */
int fl_out_resume(fl_out *out, const char *path, int gzip, const fl_file_mark *mark, int *fresh, fl_err *err);

/* Drop what was written: the final name is not touched.  Accepts a zeroed or closed struct. */
void fl_out_abort(fl_out *out);

#endif
