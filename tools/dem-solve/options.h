/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of dem-solve. */
#ifndef DEM_SOLVE_OPTIONS_H
#define DEM_SOLVE_OPTIONS_H
#include <stdint.h>
#include "base/tool.h"

enum { SETS_MAX = 200 };

struct options {
    const char *scene, *ice, *structure; /* borrowed from argv; NULL: not given */
    const char *direction;               /* --direction; borrowed from argv */
    const char *set[SETS_MAX];
    int sets;
    const char *out, *report, *explain, *resume, *again, *factor; /* NULL: not given */
    double probe;                                                 /* < 0: not asked for [m] */
    int plan, echo, force, gzip, quiet, verbose, threads;
    int ended; /* --help or --version has said all there is to say */
};

/* Answers --help and --version itself.  -1 with FL_USAGE. */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);

/* What bears on the result, for the history. */
void options_by(const struct options *o, fl_history_line *by);

#endif
