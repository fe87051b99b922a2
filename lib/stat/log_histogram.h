/* SPDX-License-Identifier: GPL-3.0-or-later */
/* log_histogram.h -- histogram with logarithmic classes that are the same for all records.
 *
 * Between two powers of two there are 128 classes of equal width, for either sign.  One class holds all
 * values nearer to 0 than 2^-1029.  The middle of a class differs from a value in it by at most 1/256 = 0.4
 * %. Histograms of several records add up class by class.
 *
 * Memory holds the classes in use only.  A record whose values span a factor of 10^6 has at most 2 * 20 *
 * 128 of them, for any length. */
#ifndef FL_STAT_LOG_HISTOGRAM_H
#define FL_STAT_LOG_HISTOGRAM_H
#include <stdint.h>
#include "base/err.h"

/* Longest interval that is accepted [s]: 35 000 years. */
#define FL_LOG_HISTOGRAM_LONGEST 0x1p40

/* A time as an integer number of 2^-64 s, seconds + part 2^-64.  Sums of such times do not depend on their
 * order. */
typedef struct {
    uint64_t seconds, part;
} fl_fixed_time;

fl_fixed_time fl_fixed_time_of(double t); /* 0 <= t <= FL_LOG_HISTOGRAM_LONGEST; truncated to 2^-64 s */
double fl_fixed_time_seconds(fl_fixed_time t);
fl_fixed_time fl_fixed_time_add(fl_fixed_time a, fl_fixed_time b);

typedef struct {
    int32_t key;        /* rises with the values of the class */
    int64_t n;          /* number of values, > 0 */
    fl_fixed_time time; /* total duration */
} fl_log_bin;

typedef struct {
    fl_log_bin *slot; /* [cap] hash table; n = 0 in empty slots */
    int32_t n, cap;   /* classes in use; a power of two, or 0 */
} fl_log_histogram;

/* The class of a finite number, and the limits of a class: lower <= x < upper for positive x,
 * lower < x <= upper for negative x, |x| < 2^-1029 in the class of 0. */
int32_t fl_log_bin_key(double x);
double fl_log_bin_lower(int32_t key);
double fl_log_bin_upper(int32_t key);

/* Add n values of class key with a total duration.  0, or -1 with FL_SYSTEM in err. */
int fl_log_histogram_add(fl_log_histogram *c, int32_t key, int64_t n, fl_fixed_time time, fl_err *err);
int fl_log_histogram_merge(fl_log_histogram *c, const fl_log_histogram *other, fl_err *err);

/* The classes in ascending order: *sorted has c->n entries, to be freed.  0, or -1 with FL_SYSTEM in err. */
int fl_log_histogram_sort(const fl_log_histogram *c, fl_log_bin **sorted, fl_err *err);

/* Quantile by time, p in 0 .. 1, linear within a class: the error is below the width of a class, 0.8 % of the
 * value.  sorted[n], n >= 1; lo and hi are the smallest and largest value. */
double fl_log_histogram_quantile(int32_t n, const fl_log_bin *sorted, double p, double lo, double hi);

/* Mean of the highest share of all values (of at least one), as fl_mean_of_highest().  Each value is replaced
 * by the middle of its class. */
double fl_log_histogram_mean_highest(int32_t n, const fl_log_bin *sorted, double share, double lo, double hi);

/* Accepts a zeroed struct and leaves one. */
void fl_log_histogram_free(fl_log_histogram *c);

#endif
