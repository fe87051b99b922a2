/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options.h -- parses the command line of loadstats. */
#ifndef LOADSTATS_OPTIONS_H
#define LOADSTATS_OPTIONS_H
#include "base/err.h"
#include "settings.h"

/* Defaults, then the command line.  0, or -1 with FL_USAGE or FL_SYSTEM in err.  Free with options_free(). */
int options_parse(struct options *o, int argc, char **argv, fl_err *err);
void options_free(struct options *o);

#endif
