/* SPDX-License-Identifier: GPL-3.0-or-later */
/* output_guard.h -- refuses an output that would overwrite an input or another output. */
#ifndef FL_BASE_OUTPUT_GUARD_H
#define FL_BASE_OUTPUT_GUARD_H
#include <stddef.h>
#include "base/err.h"

/* A path and the option or key that names it.  path is NULL or "" for none, "-" for a standard stream. */
typedef struct {
    const char *what, *path;
} fl_named_path;

/* Returns 0, or -1 with FL_USAGE where an output is an input or an earlier output.  Files are compared by
 * identity: another name, a link, the file behind standard output, and the unfinished name PATH.part
 * (stream.h) all count.  Devices, pipes and terminals may appear twice.  in needs no `what`. */
int fl_output_guard_check(const fl_named_path *out, size_t outs, const fl_named_path *in, size_t ins,
                          fl_err *err);

/* True if both paths lead to the same file. */
int fl_same_file(const char *a, const char *b);

#endif
