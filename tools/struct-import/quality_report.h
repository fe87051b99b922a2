/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quality_report.h -- what struct-import says on standard error. */
#ifndef STRUCT_IMPORT_QUALITY_REPORT_H
#define STRUCT_IMPORT_QUALITY_REPORT_H
#include "cleanup.h"
#include "options.h"

/* The quality tables of s, whose part i was mended as m[i], with a row for all of it when there are several
 * parts; then the warnings. */
int report(const struct options *o, const fl_surface *s, const struct mended *m, fl_err *err);

#endif
