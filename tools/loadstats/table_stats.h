/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_stats.h -- rows of the tables stats, peaks, histogram and exceedance; loads(5) defines the
 * columns. */
#ifndef LOADSTATS_TABLE_STATS_H
#define LOADSTATS_TABLE_STATS_H
#include "cell.h"
#include "settings.h"

/* Rows of one view; see table_kind.h.  Cannot fail. */
int stats_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
               int w, fl_err *err);
int peaks_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
               int w, fl_err *err);
int exceedance_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                    int32_t signal, int w, fl_err *err);

/* Rows of all views of a signal.  0, or -1 with FL_SYSTEM in err. */
int histogram_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                   int32_t signal, fl_err *err);

/* Columns of the table stats from the quantiles on. */
void stats_more_columns(FILE *f, const struct options *o);

#endif
