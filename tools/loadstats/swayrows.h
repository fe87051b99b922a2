/* SPDX-License-Identifier: GPL-3.0-or-later */
/* swayrows.h -- the tables response and motion: what a load does to an oscillator. */
#ifndef LOADSTATS_SWAYROWS_H
#define LOADSTATS_SWAYROWS_H
#include "stat/oscillator.h"
#include "statrows.h"

/* The names of the columns after those that all tables have. */
void swayrows_header(FILE *f, const struct options *o);

/* The rows of one view, of TABLE_RESPONSE or TABLE_MOTION, oscillator by oscillator.
 * 0, or -1 with FL_INPUT (more steps than can be taken, a segment that the record cannot carry) or FL_SYSTEM
 * in err. */
int swayrows_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                   int w, fl_err *err);

#endif
