/* SPDX-License-Identifier: GPL-3.0-or-later */
/* table_summary.h -- rows of tables from the summaries of runs: stats, histogram, fits, levels, damage,
 * cycles, ensemble. */
#ifndef LOADSTATS_TABLE_SUMMARY_H
#define LOADSTATS_TABLE_SUMMARY_H
#include <stdio.h>
#include "stat/summary.h"
#include "settings.h"

/* Mean, largest and smallest value of each run, in the order of the files. */
enum { ENSEMBLE_VALUES = 3 };
typedef struct {
    int32_t runs, cap, signals;
    double *x; /* [runs][signals][ENSEMBLE_VALUES] */
} ensemble;

/* The summary of all runs.  Its multisets are sorted before rows are printed. */
struct run_set {
    fl_summary all;
    ensemble e;        /* of the table ensemble */
    const char *start; /* line that says which start-up is left out, "" for none; or NULL */
    char *scene;       /* of the first run that says it, ice-scenes(7); NULL: none does */
};

/* Add one run.  0, or -1 with FL_INPUT (a summary of several runs, other parts or signals) or FL_SYSTEM in
 * err. */
int ensemble_add(ensemble *e, const fl_summary *all, const fl_summary *one, const char *name, fl_err *err);

/* Rows of one entry of the summary; fits_of_runs() prints fits or levels.  0, or -1 with FL_INPUT (no maxima
 * of blocks) or FL_SYSTEM in err. */
int stats_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);
int histogram_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o,
                      fl_err *err);
int fits_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);
int cycles_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);
int damage_of_runs(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);
int ensemble_rows(FILE *f, const struct run_set *runs, int32_t entry, const struct options *o, fl_err *err);

#endif
