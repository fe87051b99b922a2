/* SPDX-License-Identifier: GPL-3.0-or-later */
/* quality_report.h -- the report of struct-import on standard error. */
#ifndef STRUCT_IMPORT_QUALITY_REPORT_H
#define STRUCT_IMPORT_QUALITY_REPORT_H
#include "cleanup.h"
#include "options.h"

/* Print the quality tables of s, whose part i has the cleanup m[i], with a total if there are several parts;
 * then the warnings. */
int print_report(const struct options *o, const fl_surface *s, const struct cleanup *m, fl_err *err);

#endif
