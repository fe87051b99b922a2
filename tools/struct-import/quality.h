/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quality.h -- what struct-import says on standard error. */
#ifndef STRUCT_IMPORT_QUALITY_H
#define STRUCT_IMPORT_QUALITY_H
#include "mend.h"
#include "options.h"

/* The quality tables of s, whose part i was mended as m[i], with a row for all of it when there are several
 * parts; then the warnings. */
int report(const struct options *o, const fl_surface *s, const struct mended *m, fl_err *err);

#endif
