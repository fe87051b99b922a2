/* SPDX-License-Identifier: GPL-3.0-or-later */
/* cell.h -- the views of a record, and the cells that every table prints. */
#ifndef LOADSTATS_CELL_H
#define LOADSTATS_CELL_H
#include <stdio.h>
#include "stat/signal_view.h"
#include "stat/uniform_step.h"

/* All views of a record: views[(part * signals + signal) * view_count + w], w = 0 raw, 1 filtered. */
struct record_views {
    const fl_series *series;
    const fl_signal_view *views;
    int view_count;                 /* 1, or 2 with a filter */
    const fl_resampling_loss *loss; /* [parts * signals] loss by --step, or NULL */
    const unsigned char *dropped;   /* [parts * signals] left out as rounding, or NULL */
    const char *start;              /* what is said of a start-up that is left out, or "" or NULL */
};

const char *view_name(int w); /* "raw", "filtered" */

/* A view; NULL where the signal does not exist for the part. */
const fl_signal_view *find_view(const struct record_views *r, int32_t part, int32_t signal, int w);

/* Significant digits of numbers; ALL_DIGITS: those that read back to the same double. */
enum { LEAST_DIGITS = 6, ALL_DIGITS = 17 };

/* Digits of all numbers from now on; LEAST_DIGITS at the start. */
void write_digits(int digits);

/* Print a number, or - when it is not finite, which means that it does not exist.  One that reads back
 * exactly with SHORT_DIGITS, as a time or a count, is printed so; others are rounded. */
enum { SHORT_DIGITS = 10 };
void write_number(FILE *f, double x);
/* The same after a tab. */
void write_cell(FILE *f, double x);
/* The first cells of a row: part, signal, unit and view. */
void write_labels(FILE *f, const struct record_views *r, int32_t part, int32_t signal, int w);

#endif
