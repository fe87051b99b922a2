/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_overview.h -- rows of the table overview: what a designer reads first, in kN and six digits. */
#ifndef LOADSTATS_TABLE_OVERVIEW_H
#define LOADSTATS_TABLE_OVERVIEW_H
#include "cell.h"
#include "settings.h"

/* Rows of one view.  0, or -1 with FL_SYSTEM in err. */
int overview_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err);

#endif
