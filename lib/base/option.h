/* SPDX-License-Identifier: GPL-3.0-or-later */
/* option.h -- what every program says of options that it does not understand. */
#ifndef FL_BASE_OPTION_H
#define FL_BASE_OPTION_H
#include <getopt.h>
#include <stdint.h>
#include "base/err.h"

/* getopt_long() has returned ':' or '?', c, with opterr = 0: says which option wants a value, takes none or
 * is none.
 *   known   the options of the program, where every letter has a word too
 *   letter  optopt;   word  the last that it looked at
 * -1 with FL_USAGE. */
int fl_option_unknown(const char *program, const struct option *known, int c, int letter, const char *word,
                      fl_err *err);

/* The value of --option as a whole number in [lo, hi].  0, or -1 with FL_USAGE. */
int fl_option_whole(const char *option, const char *text, int32_t lo, int32_t hi, int32_t *x, fl_err *err);

#endif
