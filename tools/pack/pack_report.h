/* SPDX-License-Identifier: GPL-3.0-or-later */
/* pack_report.h -- the certificate of a packing: rows of quantity, unit, asked, achieved, distance, note. */
#ifndef PACK_PACK_REPORT_H
#define PACK_PACK_REPORT_H
#include "pack_run.h"

/* The table of kind certificate into o->certificate. */
int report_write(const struct options *o, const struct result *r, const fl_history_line *by, fl_err *err);

/* The same for a reader, on standard error. */
void report_print(const struct options *o, const struct result *r);

#endif
