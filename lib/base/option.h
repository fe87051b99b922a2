/* SPDX-License-Identifier: GPL-3.0-or-later */
/* option.h -- messages about invalid command-line options. */
#ifndef FL_BASE_OPTION_H
#define FL_BASE_OPTION_H
#include <getopt.h>
#include <stdint.h>
#include "base/err.h"

/* Reports an option that getopt_long() rejected: missing value, superfluous value or unknown option.
 *   known   the options of the program, each letter with a long name
 *   c       ':' or '?' as returned by getopt_long() with opterr = 0
 *   letter  optopt;   word  the last argument examined
 * Returns -1 with FL_USAGE. */
int fl_option_unknown(const char *program, const struct option *known, int c, int letter, const char *word,
                      fl_err *err);

/* Reads the value of --option as an integer in [lo, hi].  Returns 0, or -1 with FL_USAGE. */
int fl_option_whole(const char *option, const char *text, int32_t lo, int32_t hi, int32_t *x, fl_err *err);

#endif
