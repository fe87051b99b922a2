/* SPDX-License-Identifier: GPL-3.0-or-later */
/* rainflow_matrix.h -- rainflow matrix: number of load cycles by class of range and class of mean. */
#ifndef FL_STAT_RAINFLOW_MATRIX_H
#define FL_STAT_RAINFLOW_MATRIX_H
#include <stdint.h>
#include "base/err.h"
#include "stat/rainflow.h"

typedef struct {
    int32_t range, mean; /* classes, counted from 0 */
    double cycles;       /* > 0 */
} fl_rainflow_matrix_cell;

/* Class i of the range is i R/n <= range < (i + 1) R/n, class j of the mean
 * lo + j (hi - lo)/n <= mean < lo + (j + 1) (hi - lo)/n; the last of each includes its upper end. */
typedef struct {
    int32_t n;                     /* classes each way */
    double largest, lo, hi;        /* R, and the limits of the means [unit of the load] */
    fl_rainflow_matrix_cell *cell; /* [cells] non-empty cells, by range, then by mean */
    int32_t cells;
} fl_rainflow_matrix;

/* Sort cycles into n >= 1 classes each way.
 *   largest       R, no range is larger
 *   lo, hi        bounds of all means; where lo = hi all are in class 0
 *   cycle[count]
 * Memory grows with the cycles, not with n^2.  Counts are halves, so their sums are exact.
 * 0, or -1 with FL_SYSTEM in err. */
int fl_rainflow_matrix_make(fl_rainflow_matrix *m, int32_t n, double largest, double lo, double hi,
                            int32_t count, const fl_cycle *cycle, fl_err *err);

/* Lower limit of class k = 0 .. n of the ranges, of the means; k = n is the upper end. */
double fl_rainflow_matrix_range(const fl_rainflow_matrix *m, int32_t k);
double fl_rainflow_matrix_mean(const fl_rainflow_matrix *m, int32_t k);

/* Accepts a zeroed struct and leaves one. */
void fl_rainflow_matrix_free(fl_rainflow_matrix *m);

#endif
