/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_fits.h -- the tables fits and levels: laws of the extremes of a view, and how far they reach. */
#ifndef LOADSTATS_TABLE_FITS_H
#define LOADSTATS_TABLE_FITS_H
#include "table_stats.h"

/* What laws are fitted to, as --sample asks for it. */
typedef struct {
    int32_t n;
    double *x;              /* [n] descending, to be freed */
    double threshold, rate; /* rate: values in a second */
    int excesses;           /* all lie above the threshold, so that a GPD makes sense */
} extreme_sample;

/* The sample of a view.  0, or -1 with FL_SYSTEM in err; s->x is to be freed either way. */
int extreme_sample_make(extreme_sample *s, const fl_signal_view *v, const struct options *o, fl_err *err);

/* The names of the columns after those that all tables have. */
void fits_header(FILE *f, const struct options *o);

/* The rows of one view.  0, or -1 with FL_SYSTEM in err. */
int fits_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal, int w,
               fl_err *err);

#endif
