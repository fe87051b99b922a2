/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sample.h -- what a law of extremes is fitted to: peaks over a threshold, or maxima of blocks. */
#ifndef FL_STAT_SAMPLE_H
#define FL_STAT_SAMPLE_H
#include "stat/peaks.h"

/* Peaks over a threshold, declustered: rows above it belong to one cluster unless the signal stays at or
 * below it for at least `gap` between them, and of each cluster the first largest value is the peak.  gap = 0
 * separates every excursion. n, x[n], edge[n + 1]   row k holds x for edge[k] .. edge[k + 1] [s] p out;
 * zeroed, or used before 0, or -1 with FL_SYSTEM in err.  Source: Coles 2001, 5.3.2, runs declustering. */
int fl_sample_peaks_over_threshold(int32_t n, const double *x, const double *edge, double threshold,
                                   double gap, fl_peaks *p, fl_err *err);

/* The first largest value of each whole block of the given length, counted from edge[0]; a row belongs to the
 * block its middle lies in, a block without rows has none, and what is left at the end is left out. blocks
 * may be NULL; else out, the number of whole blocks of the record. 0, or -1 with FL_SYSTEM in err. */
int fl_sample_block_maxima(int32_t n, const double *x, const double *edge, double length, fl_peaks *p,
                           int32_t *blocks, fl_err *err);

#endif
