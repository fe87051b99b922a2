/* SPDX-License-Identifier: GPL-3.0-or-later */
/* statrows.h -- what loadstats prints; the columns are specified in loads(5). */
#ifndef LOADSTATS_STATROWS_H
#define LOADSTATS_STATROWS_H
#include <stdio.h>
#include "base/tool.h"
#include "stat/evenly.h"
#include "stat/view.h"
#include "options.h"

/* Everything there is to report: views[(part * signals + signal) * each + w], w = 0 raw, 1 filtered. */
struct result {
    const fl_series *s;
    const fl_view *views;
    int each;                   /* 1, or 2 with a filter */
    const fl_evenly_loss *loss; /* [parts * signals] what --step took, or NULL */
};

const char *view_name(int w); /* "raw", "filtered" */
const fl_view *view_of(const struct result *r, int32_t part, int32_t signal,
                       int w); /* NULL where there is none */

/* Print a number, or - when it is not finite: it does not exist. */
void put_number(FILE *f, double x);
/* The same after a tab. */
void put_field(FILE *f, double x);
/* What every row begins with: part, signal, unit and view. */
void put_label(FILE *f, const struct result *r, int32_t part, int32_t signal, int w);

/* The row of column names. */
void statrows_header(FILE *f, const struct options *o);

/* Print the table that was asked for.  0, or -1 with FL_SYSTEM in err. */
int statrows_write(FILE *f, const struct result *r, const struct options *o, const fl_by *by, fl_err *err);

#endif
