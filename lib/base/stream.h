/* SPDX-License-Identifier: GPL-3.0-or-later */
/* stream.h -- byte input from a file or standard input, plain or gzip; byte output to a file or standard
 * output.  An output file gets its final name only when it is complete. */
#ifndef FL_BASE_STREAM_H
#define FL_BASE_STREAM_H
#include <stdint.h>
#include <stdio.h>
#include "base/err.h"

typedef struct fl_in fl_in;

/* Opens a file, or standard input for "-".  Gzip is recognised by its first two bytes.
 * NULL with FL_INPUT (missing, a folder, unreadable) or FL_SYSTEM. */
fl_in *fl_in_open(const char *path, fl_err *err);

/* Same for n bytes in memory.  data and name, which messages use, stay the caller's. */
fl_in *fl_in_open_bytes(const char *name, const void *data, int64_t n, fl_err *err);

/* Reads up to n bytes.  Returns the number read, 0 at the end, -1 with FL_INPUT (damaged gzip, read error).
 * A short count is not the end: data are returned as they arrive from a pipe. */
int64_t fl_in_read(fl_in *in, void *buf, int64_t n, fl_err *err);

/* Follows a file that another program still writes: at its end it is read again, until it has not grown for
 * `seconds`.  0, the default, ends at the end of the file. */
void fl_in_follow(fl_in *in, double seconds);

/* The name for messages: the path, or "<stdin>". */
const char *fl_in_name(const fl_in *in);
void fl_in_close(fl_in *in); /* NULL is accepted */

typedef struct {
    FILE *f;          /* write here; NULL when closed */
    char *path, *tmp; /* both NULL for standard output; tmp NULL for a device or a pipe */
    void *gz;         /* the compressor, or NULL */
    int keep_part;    /* tmp is kept on failure: its contents are usable */
} fl_out;

/* A position in an output file from which a later run can continue. */
typedef struct {
    int64_t offset; /* bytes before the mark; -1 if the output has no positions, as a pipe */
    uint64_t
        tail_hash; /* hash of the last bytes before the mark, at most FL_FILE_MARK_TAIL; 0: not readable */
} fl_file_mark;
enum { FL_FILE_MARK_TAIL = 4096 };

/* Opens path for writing ("-" is standard output).  gzip 1 compresses, 2 faster and less.  A link is
 * followed; a device or a pipe (/dev/null, a fifo) is written directly.  The unfinished file PATH.part is
 * locked; a file that is being written by something else is refused and left alone.  -1 with FL_SYSTEM. */
int fl_out_open(fl_out *out, const char *path, int gzip, fl_err *err);

/* Flushes to the operating system, as after a row.  -1 with FL_SYSTEM if this or an earlier write failed; the
 * message names the unfinished file if that is kept. */
int fl_out_flush(fl_out *out, fl_err *err);

/* Name PATH.part of the unfinished file, to be freed.  NULL for a device or a pipe, or without memory. */
char *fl_out_part_path(const char *path);

/* Flushes, syncs and renames the file to its final name, and syncs the folder.  -1 with FL_SYSTEM if any data
 * were lost.  Then the final name is not changed, and the unfinished file is removed, or, where it is kept,
 * stays in PATH.part up to its last complete line. */
int fl_out_close(fl_out *out, fl_err *err);

/* Syncs the output to disk and returns its position.  From here on PATH.part is kept on failure, since the
 * mark refers to it.  Compressed output ends a gzip member here and starts another, so that the bytes after
 * the mark do not depend on those before.  -1 with FL_SYSTEM. */
int fl_out_mark(fl_out *out, fl_file_mark *mark, fl_err *err);

/* Checks that the file of a mark exists: PATH.part, or PATH if that run ended, long enough and with the same
 * bytes before the mark.  Nothing is changed.  0, or -1 with FL_INPUT.  Marks without a position and standard
 * output always pass. */
int fl_out_check_mark(const char *path, const fl_file_mark *mark, fl_err *err);

/* Opens the output as fl_out_open() does and continues at the mark; data behind it are cut off.  Standard
 * output is continued if it is the marked file (>> in the shell).  *fresh is 1 if there is nothing to
 * continue and the output starts anew: a pipe, a device, another file as standard output.  -1 with FL_INPUT
 * or FL_SYSTEM. */
int fl_out_resume(fl_out *out, const char *path, int gzip, const fl_file_mark *mark, int *fresh, fl_err *err);

/* Discards the output; the final name is not touched.  Accepts a zeroed or closed struct. */
void fl_out_abort(fl_out *out);

#endif
