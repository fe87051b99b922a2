/* SPDX-License-Identifier: GPL-3.0-or-later */
/* analyse_record.h -- statistics of one record: tables, pictures and report. */
#ifndef LOADSTATS_ANALYSE_RECORD_H
#define LOADSTATS_ANALYSE_RECORD_H
#include "base/err.h"
#include "settings.h"

/* Read the record and write table, pictures and report.  0, or -1 with err. */
int analyse_record(const struct options *o, fl_err *err);

#endif
