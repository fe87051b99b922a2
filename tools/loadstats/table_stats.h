/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_stats.h -- what loadstats prints; the columns are specified in loads(5). */
#ifndef LOADSTATS_TABLE_STATS_H
#define LOADSTATS_TABLE_STATS_H
#include <stdio.h>
#include "base/tool.h"
#include "stat/uniform_step.h"
#include "stat/signal_view.h"
#include "options.h"

/* Everything there is to report: views[(part * signals + signal) * each + w], w = 0 raw, 1 filtered. */
struct result {
    const fl_series *s;
    const fl_signal_view *views;
    int each;                       /* 1, or 2 with a filter */
    const fl_resampling_loss *loss; /* [parts * signals] what --step took, or NULL */
};

const char *view_name(int w); /* "raw", "filtered" */
const fl_signal_view *view_of(const struct result *r, int32_t part, int32_t signal,
                              int w); /* NULL where there is none */

/* Print a number, or - when it is not finite: it does not exist. */
void put_number(FILE *f, double x);
/* The same after a tab. */
void write_cell(FILE *f, double x);
/* What every row begins with: part, signal, unit and view. */
void write_labels(FILE *f, const struct result *r, int32_t part, int32_t signal, int w);

/* The row of column names. */
void stats_header(FILE *f, const struct options *o);

/* Print the table that was asked for.  0, or -1 with FL_SYSTEM in err. */
int table_write(FILE *f, const struct result *r, const struct options *o, const fl_history_line *by,
                fl_err *err);

#endif
