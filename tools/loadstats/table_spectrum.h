/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_spectrum.h -- rows of the tables spectrum and frequency: power spectral density and dominant
 * frequency. */
#ifndef LOADSTATS_TABLE_SPECTRUM_H
#define LOADSTATS_TABLE_SPECTRUM_H
#include "stat/power_spectrum.h"
#include "cell.h"
#include "settings.h"

/* The spectrum of a view with the window and segment of the settings.  A view of unequal intervals is
 * resampled to as many equal ones.  0, or -1 with FL_INPUT (a segment longer than the record) or FL_SYSTEM
 * in err. */
int spectrum_make(fl_power_spectrum *s, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err);

/* Rows of one view.  0, or -1 with the errors of spectrum_make(). */
int spectrum_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                  int32_t signal, int w, fl_err *err);
int frequency_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                   int32_t signal, int w, fl_err *err);

#endif
