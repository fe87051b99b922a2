/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_regimes.h -- regimes of ice-induced vibration (stat/regime.h): a row for each window, or for each
 * regime. */
#ifndef LOADSTATS_TABLE_REGIMES_H
#define LOADSTATS_TABLE_REGIMES_H
#include "cell.h"
#include "settings.h"
#include "stat/regime.h"

/* The columns that these tables read, in the place of --column; speed: the ice has that of --speed, and the
 * record no column for it. Returns their number. */
enum { REGIME_SIGNALS = 8 };
int regime_signals(const char *signal[REGIME_SIGNALS], int speed);

/* Windows of a part. */
struct regime_windows {
    int32_t n, each; /* windows, and rows of one */
    fl_regime_window *window;
    double *memory; /* load, x, velocity, ice of all rows, one after the other */
    int32_t rows;
    double dt;
};
int regimes_make(struct regime_windows *w, const struct record_views *r, const struct options *o,
                 int32_t part, fl_err *err);
void regimes_free(struct regime_windows *w);

int regime_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err);
int regime_share_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part,
                      int32_t signal, int w, fl_err *err);

#endif
