/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_fits.h -- rows of the tables fits and levels: distributions of the extremes of a view, return
 * levels. */
#ifndef LOADSTATS_TABLE_FITS_H
#define LOADSTATS_TABLE_FITS_H
#include "cell.h"
#include "settings.h"

/* Values for an extreme-value analysis, as --sample selects them. */
typedef struct {
    int32_t n;
    double *x;              /* [n] descending, to be freed */
    double threshold, rate; /* rate: values per second */
    int excesses;           /* all lie above the threshold, so a GPD applies */
} extreme_sample;

/* The sample of a view.  0, or -1 with FL_SYSTEM in err; s->x is to be freed either way. */
int extreme_sample_make(extreme_sample *s, const fl_signal_view *v, const struct options *o, fl_err *err);

/* Level of the best distribution: of those that the sample does not contradict, whose interval has ends and
 * says something, the one with the smallest AIC.  law is NULL where there is none, or fewer values than
 * BEST_LEVEL_LEAST: a few peaks are events, no statistics. */
enum { BEST_LEVEL_LEAST = 30 };
typedef struct {
    int32_t n; /* values */
    const char *law;
    double level, low, high;
} best_level;
int best_level_make(best_level *b, const fl_signal_view *v, const struct options *o, double period,
                    fl_err *err);

/* Rows of one view.  0, or -1 with FL_SYSTEM in err. */
int fits_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
              int w, fl_err *err);
int levels_rows(FILE *f, const struct record_views *r, const struct options *o, int32_t part, int32_t signal,
                int w, fl_err *err);

#endif
