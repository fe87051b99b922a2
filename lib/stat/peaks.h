/* SPDX-License-Identifier: GPL-3.0-or-later */
/* peaks.h -- separate peaks of a record, by Rayleigh separation. */
#ifndef FL_STAT_PEAKS_H
#define FL_STAT_PEAKS_H
#include <math.h>
#include <stdint.h>
#include "base/err.h"

/* What counts as a peak: the maxima of y = x, of y = -x, or of y = |x|. */
enum fl_peak_side { FL_PEAK_MAX, FL_PEAK_MIN, FL_PEAK_ABS, FL_PEAK_SIDES };

/* "max", "min", "abs" */
const char *fl_peak_side_name(int side);

/* y of x. */
static inline double fl_peak_turned(int side, double x)
{
    return side == FL_PEAK_MAX ? x : side == FL_PEAK_ABS ? fabs(x) : -x;
}

typedef struct {
    int32_t n, cap;
    int32_t *row; /* [n] rows of the record, rising */
} fl_peaks;

/* Peaks by Rayleigh separation.  A maximum is a value, or a run of equal values, with a smaller one before
 * it and a smaller one after it.  The ends of the record are no maxima: their other side is unknown.  The
 * first row of a run represents it.  Maxima at or below the threshold do not count.  Two neighbouring maxima
 * are separate peaks when
 *     min of the record between them < ratio * (the smaller of the two),
 * otherwise the smaller one is dropped (the later one, when they are equal).
 *   x[n]
 *   ratio      0 .. 1, usually 0.5
 *   threshold  in the unit of x; >= 0, as the rule compares fractions of a peak
 *   p          out; zeroed, or used before, whose memory is reused
 * 0, or -1 with FL_SYSTEM in err.
 * Source: ship and structure practice, as Chai, Leira & Naess 2018, Cold Regions Sci. Technol. use it. */
int fl_peaks_rayleigh(int32_t n, const double *x, double ratio, double threshold, fl_peaks *p, fl_err *err);

/* Accepts a zeroed struct and leaves one. */
void fl_peaks_free(fl_peaks *p);

#endif
