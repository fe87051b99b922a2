/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_parts.h -- rows of the tables legs and events: parts of a structure side by side, and loading
 * events. */
#ifndef LOADSTATS_TABLE_PARTS_H
#define LOADSTATS_TABLE_PARTS_H
#include "cell.h"
#include "settings.h"

/* Rows of one view.  Cannot fail. */
int legs_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
              int w, fl_err *err);
int events_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err);

#endif
