/* SPDX-License-Identifier: GPL-3.0-or-later */
/* block_report.h -- the certificate of block-cut, as a table and on standard error. */
#ifndef BLOCK_CUT_BLOCK_REPORT_H
#define BLOCK_CUT_BLOCK_REPORT_H
#include "block_result.h"
#include "options.h"

int block_report_write(const struct options *o, const struct result *r, const fl_history_line *by,
                       fl_err *err);
void block_report_print(const struct options *o, const struct result *r);

/* -1 with FL_NUMERIC if blocks, volume or areas are not those expected. */
int block_report_answer(const struct result *r, fl_err *err);

#endif
