/* SPDX-License-Identifier: GPL-3.0-or-later */
/* signal_view.h -- one signal, raw or filtered, with its descriptive statistics, peaks and ranks. */
#ifndef FL_STAT_SIGNAL_VIEW_H
#define FL_STAT_SIGNAL_VIEW_H
#include <stdint.h>
#include "stat/butterworth.h"
#include "stat/descriptive_stats.h"
#include "stat/peaks.h"
#include "stat/series.h"

typedef struct {
    int32_t n;
    const double *t, *edge, *x; /* [n], [n + 1], [n]: borrowed from the series, or in owned */
    double *owned;              /* memory of a filtered view, or NULL */
    const double *y;            /* [n] the signal whose maxima are the peaks: x, or turned */
    double *turned;             /* memory of y where it is not x, or NULL */
    fl_descriptive_stats stats;
    fl_peaks peaks;
    int32_t *peak_rank; /* [peaks.n] peak_rank[0] is the index in peaks.row of the largest */
    double *peak_value; /* [peaks.n] the peaks, of y, in descending order */
    double *quantile;   /* [quantiles] */
} fl_signal_view;

/* Butterworth low, high and band pass, or a moving mean. */
enum fl_filter_kind { FL_FILTER_LOW, FL_FILTER_HIGH, FL_FILTER_BAND, FL_FILTER_MEAN, FL_FILTER_KINDS };

/* "low", "high", "band", "mean" */
const char *fl_filter_name(int kind);

/* Settings of a view.
 *   filter       -3 dB frequency of one pass, or the lower one of a band [Hz], or the length of a moving mean
 *                [s]; 0 for the raw view
 *   kind, upper  fl_filter_kind; the upper frequency of a band [Hz]
 *   order        of a Butterworth filter
 *   ratio, threshold   of fl_peaks_rayleigh(), for y; a threshold below 0 is 0 there
 *   side         fl_peak_side
 *   p[quantiles] in 0 .. 1 */
typedef struct {
    double filter, upper;
    int kind, order;
    double ratio, threshold;
    int side;
    int32_t quantiles;
    const double *p;
} fl_signal_view_settings;

/* View of signal s of part p.  The raw view and a moving mean, fl_moving_mean(), keep the rows.  A
 * Butterworth filter needs equal intervals: the rows are kept when their intervals are equal, otherwise
 * replaced by as many equal ones, fl_resample_means(); t is then the end of the interval in a loads table
 * and the middle in any other.  The series must live as long as the view.  0, or -1 with FL_INPUT (a record
 * too short for the filter) or FL_SYSTEM in err; v is then empty. */
int fl_signal_view_make(fl_signal_view *v, const fl_series *s, int32_t part, int32_t signal,
                        const fl_signal_view_settings *settings, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_signal_view_free(fl_signal_view *v);

#endif
