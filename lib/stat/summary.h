/* SPDX-License-Identifier: GPL-3.0-or-later */
/* summary.h -- summary of any number of runs in constant memory; summaries add up in any order.
 *
 * A run is one record.  For each signal of each part a summary holds
 *     the exact sums of w x^k, k = 0 .. 4, w the duration of a row (exact_sum.h);
 *     smallest and largest value, each with its first time in its run (the earliest of equal ones);
 *     the duration of values, the number of separate peaks by height and of cycles by range, in logarithmic
 *     classes (log_histogram.h); the exact sum of the peaks;
 *     the largest value of every whole block of a run; mean, std, smallest and largest value of every run.
 * Peaks, cycles and blocks belong to one run and do not continue in another.  What is open at the end of a
 * run (the residue of rainflow, an incomplete block) is closed there.  Nothing else in a summary depends on
 * which values came together, so the summary of many runs is the same to the byte for any order and
 * grouping.
 *
 * Memory grows with the number of blocks, of runs and of classes in use, not with that of rows. */
#ifndef FL_STAT_SUMMARY_H
#define FL_STAT_SUMMARY_H
#include <stdint.h>
#include "base/err.h"
#include "stat/log_histogram.h"
#include "stat/exact_sum.h"

/* Settings, equal for all runs of a summary.
 *   separation, threshold   of the peaks, fl_peaks_rayleigh()
 *   side                    fl_peak_side: peaks and largest values of blocks are those of the turned signal
 *   block                   length of a block [s], 0 for none
 *   rule, residue           of the cycles, rainflow.h */
typedef struct {
    double separation, threshold, block;
    int side, rule, residue;
} fl_summary_settings;

/* A multiset of values: x[k] occurs count[k] times. */
typedef struct {
    double x;
    int64_t count;
} fl_multiset_entry;
typedef struct {
    int32_t n, cap;
    fl_multiset_entry *v;
} fl_multiset;

enum fl_run_value { FL_RUN_MEAN, FL_RUN_STD, FL_RUN_MIN, FL_RUN_MAX, FL_RUN_VALUES };

typedef struct {
    char *part, *signal, *unit;
    int64_t rows, peaks;
    double from, to; /* from the earliest start to the latest end of a run [s] */
    double min, max, t_min, t_max;
    fl_exact_sum sum[5], peak_sum;
    fl_log_histogram level, peak, cycle; /* n of a cycle counts halves */
    fl_multiset block;                   /* maxima */
    fl_multiset run[FL_RUN_VALUES];      /* one value per run */
} fl_summary_signal;

typedef struct {
    fl_summary_settings settings;
    /* The chains of "#by" and "#stopped" lines of all runs, each once, in alphabetical order; NULL: none. */
    char *history;
    fl_summary_signal *entry; /* [n] by part, the total last, then by signal */
    int32_t n, cap;
} fl_summary;

/* Add other to s; an empty s adopts its settings.  name identifies other in messages.
 * 0, or -1 with FL_INPUT (other settings, another unit) or FL_SYSTEM. */
int fl_summary_merge(fl_summary *s, const fl_summary *other, const char *name, fl_err *err);

/* The entry of a signal, created empty where there is none yet; borrowed until the next call.  NULL with
 * FL_SYSTEM, or with FL_INPUT where it has another unit, in err. */
fl_summary_signal *fl_summary_get_signal(fl_summary *s, const char *part, const char *signal,
                                         const char *unit, const char *name, fl_err *err);

/* Copy an entry except part, signal and unit.  0, or -1 with FL_SYSTEM in err. */
int fl_summary_copy_signal(fl_summary_signal *to, const fl_summary_signal *from, fl_err *err);

/* Add one or several chains of "#by" lines to the history: each line with " --summary" ends a chain. */
int fl_summary_add_history(fl_summary *s, const char *lines, fl_err *err);

/* Add a value count >= 1 times.  0, or -1 with FL_SYSTEM in err. */
int fl_multiset_add(fl_multiset *v, double x, int64_t count, fl_err *err);

/* Sort in ascending order and join equal values. */
void fl_multiset_sort(fl_multiset *v);

/* Number of values. */
int64_t fl_multiset_size(const fl_multiset *v);

/* Mean, std, skew and kurtosis, by fl_exact_moments(). */
void fl_summary_moments(const fl_summary_signal *s, double out[4]);

/* Accepts a zeroed struct and leaves one. */
void fl_summary_free(fl_summary *s);

#endif
