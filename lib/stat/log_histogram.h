/* SPDX-License-Identifier: GPL-3.0-or-later */
/* log_histogram.h -- a histogram whose classes are the same for all records, so that histograms add up: between two
 * powers of two there are 128 classes of equal width, of either sign, and one class for all that is nearer to
 * 0 than 2^-1029.  The middle of a class is off by at most 1/256 = 0.4 % of what lies in it.
 *
 * Only classes that hold something take memory: a record whose values span a factor of a million has at most
 * 2 * 20 * 128 of them, however long it is. */
#ifndef FL_STAT_LOG_HISTOGRAM_H
#define FL_STAT_LOG_HISTOGRAM_H
#include <stdint.h>
#include "base/err.h"

/* Longer intervals are refused: 35 000 years. */
#define FL_LOG_HISTOGRAM_LONGEST 0x1p40

/* A time as an integer number of 2^-64 s, so that sums of times have no order either: seconds + part 2^-64.
 */
typedef struct {
    uint64_t seconds, part;
} fl_fixed_time;

fl_fixed_time
fl_fixed_time_of(double t); /* 0 <= t <= FL_LOG_HISTOGRAM_LONGEST; what is below 2^-64 s is cut off */
double fl_fixed_time_seconds(fl_fixed_time t);
fl_fixed_time fl_fixed_time_add(fl_fixed_time a, fl_fixed_time b);

typedef struct {
    int32_t key;        /* rises with the values of the class */
    int64_t n;          /* how many values, > 0 */
    fl_fixed_time time; /* for how long */
} fl_log_bin;

typedef struct {
    fl_log_bin *slot; /* [cap] hash table; n = 0 in empty slots */
    int32_t n, cap;   /* classes in use; a power of two, or 0 */
} fl_log_histogram;

/* The class of a finite number, and its limits: what lies in it is lower <= x < upper when positive,
 * lower < x <= upper when negative, |x| < 2^-1029 in the class of 0. */
int32_t fl_log_bin_key(double x);
double fl_log_bin_lower(int32_t key);
double fl_log_bin_upper(int32_t key);

/* Add n values of class key that last for a time.  0, or -1 with FL_SYSTEM in err. */
int fl_log_histogram_add(fl_log_histogram *c, int32_t key, int64_t n, fl_fixed_time time, fl_err *err);
int fl_log_histogram_merge(fl_log_histogram *c, const fl_log_histogram *other, fl_err *err);

/* The classes in ascending order: *sorted has c->n entries, to be freed.  0, or -1 with FL_SYSTEM in err. */
int fl_log_histogram_sort(const fl_log_histogram *c, fl_log_bin **sorted, fl_err *err);

/* The value that a share p in 0 .. 1 of the time does not exceed: linear within a class, so off by less than
 * the width of one, 0.8 % of the value.  sorted[n], n >= 1; lo and hi are the smallest and largest value. */
double fl_log_histogram_quantile(int32_t n, const fl_log_bin *sorted, double p, double lo, double hi);

/* Mean of the highest share of all values (at least of one), as fl_mean_of_highest(), with the middle of a
 * class for what lies in it. */
double fl_log_histogram_mean_highest(int32_t n, const fl_log_bin *sorted, double share, double lo, double hi);

/* Accepts a zeroed struct and leaves one. */
void fl_log_histogram_free(fl_log_histogram *c);

#endif
