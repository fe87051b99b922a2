/* SPDX-License-Identifier: GPL-3.0-or-later */
/* options_check.h -- checks options of loadstats against each other. */
#ifndef LOADSTATS_OPTIONS_CHECK_H
#define LOADSTATS_OPTIONS_CHECK_H
#include "base/err.h"
#include "settings.h"

/* Rejects options that exclude or need each other; --merge without --table selects the table summary.
 * 0, or -1 with FL_USAGE. */
int options_check(struct options *o, fl_err *err);

#endif
