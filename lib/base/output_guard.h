/* SPDX-License-Identifier: GPL-3.0-or-later */
/* output_guard.h -- what is written is not what is read, nor written twice, whatever the files are called. */
#ifndef FL_BASE_OUTPUT_GUARD_H
#define FL_BASE_OUTPUT_GUARD_H
#include <stddef.h>
#include "base/err.h"

/* A file, and the option or key that names it; path NULL or "" for none, "-" for a standard stream. */
typedef struct {
    const char *what, *path;
} fl_named_path;

/* -1 with FL_USAGE where an output is an input or an earlier output: by another name, through a link, as the
 * file that standard output is, or as the name that a file has until it is whole (stream.h).  Devices, pipes
 * and terminals may come twice.  in needs no `what`. */
int fl_output_guard_check(const fl_named_path *out, size_t outs, const fl_named_path *in, size_t ins,
                          fl_err *err);

/* Whether both lead to one file. */
int fl_same_file(const char *a, const char *b);

#endif
