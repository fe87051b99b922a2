/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- the command line of voronoi-ice. */
#ifndef VORONOI_ICE_OPTIONS_H
#define VORONOI_ICE_OPTIONS_H
#include "base/err.h"
#include "recipe.h"

/* Set the defaults, then parse the command line.  ended is set if --help or --version was answered.
 * Returns 0, or -1 with FL_USAGE. */
int options_parse(struct recipe *o, int *ended, int argc, char **argv, fl_err *err);

#endif
