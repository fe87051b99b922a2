/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_response.h -- rows of the tables response and motion: response of an oscillator to a load. */
#ifndef LOADSTATS_TABLE_RESPONSE_H
#define LOADSTATS_TABLE_RESPONSE_H
#include "stat/oscillator.h"
#include "cell.h"
#include "settings.h"

/* Rows of one view, oscillator by oscillator.  0, or -1 with FL_INPUT (too many steps, a segment longer than
 * the record) or FL_SYSTEM in err. */
int response_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err);
int motion_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err);

#endif
