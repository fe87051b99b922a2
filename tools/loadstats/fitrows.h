/* SPDX-License-Identifier: GPL-3.0-or-later */
/* fitrows.h -- the tables fits and levels: laws of the extremes of a view, and how far they reach. */
#ifndef LOADSTATS_FITROWS_H
#define LOADSTATS_FITROWS_H
#include "statrows.h"

/* What laws are fitted to, as --sample asks for it. */
typedef struct {
    int32_t n;
    double *x;              /* [n] descending, to be freed */
    double threshold, rate; /* rate: values in a second */
    int excesses;           /* all lie above the threshold, so that a GPD makes sense */
} fit_sample;

/* The sample of a view.  0, or -1 with FL_SYSTEM in err; s->x is to be freed either way. */
int fitrows_sample(fit_sample *s, const fl_view *v, const struct options *o, fl_err *err);

/* The names of the columns after those that all tables have. */
void fitrows_header(FILE *f, const struct options *o);

/* The rows of one view.  0, or -1 with FL_SYSTEM in err. */
int fitrows_write(FILE *f, const struct result *r, const struct options *o, int32_t part, int32_t signal,
                  int w, fl_err *err);

#endif
