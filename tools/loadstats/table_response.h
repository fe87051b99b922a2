/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_response.h -- the tables response and motion: what a load does to an oscillator. */
#ifndef LOADSTATS_TABLE_RESPONSE_H
#define LOADSTATS_TABLE_RESPONSE_H
#include "stat/oscillator.h"
#include "table_stats.h"

/* The names of the columns after those that all tables have. */
void response_header(FILE *f, const struct options *o);

/* The rows of one view, of TABLE_RESPONSE or TABLE_MOTION, oscillator by oscillator.
 * 0, or -1 with FL_INPUT (more steps than can be taken, a segment that the record cannot carry) or FL_SYSTEM
 * in err. */
int response_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                   int w, fl_err *err);

#endif
