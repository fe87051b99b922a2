/* SPDX-License-Identifier: GPL-3.0-or-later */
/* generator.h -- a generator: one way to make an ice field from a recipe.
 *
 * A generator is a file NAME.c with its header, and a row of generator_table.c.  --help, the check of options
 * and the history line take what they need from the row. */
#ifndef VORONOI_ICE_GENERATOR_H
#define VORONOI_ICE_GENERATOR_H
#include "base/err.h"
#include "base/tool.h"

struct recipe;

struct generator {
    const char *name;     /* long option that selects it, without "--"; NULL: the default generator */
    const char *argument; /* of that option, as in --help; NULL: none */
    const char *help;     /* its text in --help; NULL: no line */
    const char *keys;     /* long options that it reads, separated by blanks; others are rejected */

    /* Check the argument.  Returns 0, or -1 with FL_USAGE.  NULL: any argument. */
    int (*check)(const char *argument, fl_err *err);

    /* Add the options that this generator reads, and others may not, to the history line. */
    void (*history)(const struct recipe *o, fl_history_line *by);

    /* Make the field; write its file and its certificate.  Returns 0, or -1 with a code in err. */
    int (*make)(struct recipe *o, fl_err *err);
};

#endif
