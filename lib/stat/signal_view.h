/* SPDX-License-Identifier: GPL-3.0-or-later */
/* signal_view.h -- one signal as it is reported: raw or filtered, with its description, peaks and ranks. */
#ifndef FL_STAT_SIGNAL_VIEW_H
#define FL_STAT_SIGNAL_VIEW_H
#include <stdint.h>
#include "stat/butterworth.h"
#include "stat/descriptive_stats.h"
#include "stat/peaks.h"
#include "stat/series.h"

typedef struct {
    int32_t n;
    const double *t, *edge, *x; /* [n], [n + 1], [n]: borrowed from the series, or the view's own */
    double *owned;              /* what a filtered view holds itself, or NULL */
    fl_descriptive_stats stats;
    fl_peaks peaks;
    int32_t *peak_rank; /* [peaks.n] rank[0] is the index in peaks.at of the largest */
    double *peak_value; /* [peaks.n] the peaks in descending order */
    double *quantile;   /* [quantiles] */
} fl_signal_view;

/* Butterworth low, high and band pass, or a moving mean. */
enum fl_filter_kind { FL_FILTER_LOW, FL_FILTER_HIGH, FL_FILTER_BAND, FL_FILTER_MEAN, FL_FILTER_KINDS };

/* "low", "high", "band", "mean" */
const char *fl_filter_name(int pass);

/* How a view is made.
 *   filter       -3 dB frequency of one pass, or the lower one of a band [Hz], or the length of a moving mean
 *                [s]; 0 for the raw view
 *   pass, upper  fl_filter_kind; the upper frequency of a band [Hz]
 *   order        of a Butterworth filter
 *   ratio, threshold   of fl_peaks_rayleigh()
 *   p[quantiles] in 0 .. 1 */
typedef struct {
    double filter, upper;
    int kind, order;
    double ratio, threshold;
    int32_t quantiles;
    const double *p;
} fl_signal_view_settings;

/* The raw view of signal s of part p takes the rows as they are.  So does a moving mean, fl_moving_mean().  A
 * view through a Butterworth filter needs equal intervals: the rows' own when they are equal, otherwise as
 * many equal ones, by fl_resample_means(); its t is the end of the interval in a loads table and the middle
 * in another. The series must live as long as the view.  0, or -1 with FL_INPUT (a filter that the record
 * cannot carry) or FL_SYSTEM in err; v is then empty. */
int fl_signal_view_make(fl_signal_view *v, const fl_series *s, int32_t part, int32_t signal,
                        const fl_signal_view_settings *ask, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_signal_view_free(fl_signal_view *v);

#endif
