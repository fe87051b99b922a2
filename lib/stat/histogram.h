/* SPDX-License-Identifier: GPL-3.0-or-later */
/* histogram.h -- histogram of weighted values in classes of equal width. */
#ifndef FL_STAT_HISTOGRAM_H
#define FL_STAT_HISTOGRAM_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t n;
    double *range; /* [n + 1] class k is range[k] <= x < range[k + 1]; the last one includes its upper end */
    double *bin;   /* [n] sum of the weights of the values in the class */
} fl_histogram;

/* n >= 1 empty classes of equal width from lo to hi.  Where lo = hi their total width is a thousandth of |lo|
 * (of 1 when lo = 0), with lo in the middle.  0, or -1 with FL_SYSTEM in err. */
int fl_histogram_make(fl_histogram *h, int32_t n, double lo, double hi, fl_err *err);

/* Add a value with its weight (its duration, or 1 for a peak).  A value outside lo .. hi is ignored. */
void fl_histogram_add(fl_histogram *h, double x, double weight);

/* Accepts a zeroed struct and leaves one. */
void fl_histogram_free(fl_histogram *h);

#endif
