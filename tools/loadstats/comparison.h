/* SPDX-License-Identifier: GPL-3.0-or-later */
/* comparison.h -- reference values to which the parts of a structure are compared. */
#ifndef LOADSTATS_COMPARISON_H
#define LOADSTATS_COMPARISON_H
#include "cell.h"

/* The list of parts contains the total, which is not a part. */
typedef struct {
    int32_t total;              /* index of the total in the list of parts, -1 for none */
    double most_mean, most_max; /* of all parts: the mean of largest magnitude, the largest value */
    double sum_max;             /* sum of the largest values of the parts */
    int32_t at;                 /* row of the largest total, -1 without a total */
} comparison;

/* Compare the parts of view w of a signal.  Cannot fail. */
comparison compare_parts(const struct record_views *r, int32_t s, int w);

#endif
