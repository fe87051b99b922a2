/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_spectrum.h -- the tables spectrum and frequency: at which frequencies a load varies. */
#ifndef LOADSTATS_TABLE_SPECTRUM_H
#define LOADSTATS_TABLE_SPECTRUM_H
#include "stat/power_spectrum.h"
#include "table_stats.h"

/* The names of the columns after those that all tables have. */
void spectrum_header(FILE *f, const struct options *o);

/* The spectrum of a view with the window and segment that were asked for; a view of unequal intervals is
 * brought to as many equal ones.  0, or -1 with FL_INPUT (a segment that the record cannot carry) or
 * FL_SYSTEM in err. */
int spectrum_make(fl_power_spectrum *s, const struct result *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err);

/* The rows of one view, of TABLE_SPECTRUM or TABLE_FREQUENCY.  0, or -1 with the errors of spectrum_make().
 */
int spectrum_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                   int w, fl_err *err);

#endif
