/* SPDX-License-Identifier: GPL-3.0-or-later */
/* sample.h -- samples for extreme-value analysis: peaks over a threshold and block maxima. */
#ifndef FL_STAT_SAMPLE_H
#define FL_STAT_SAMPLE_H
#include "stat/peaks.h"

/* Peaks over a threshold, declustered.  Rows above the threshold belong to one cluster unless the signal
 * stays at or below it for at least `gap` between them.  The first largest value of each cluster is the
 * peak.  gap = 0 separates every excursion.
 *   n, x[n], edge[n + 1]   row k holds x for edge[k] .. edge[k + 1] [s]
 *   p                      out; zeroed, or used before
 * 0, or -1 with FL_SYSTEM in err.  Source: Coles 2001, 5.3.2, runs declustering. */
int fl_sample_peaks_over_threshold(int32_t n, const double *x, const double *edge, double threshold,
                                   double gap, fl_peaks *p, fl_err *err);

/* The first largest value of each whole block of the given length, counted from edge[0].  A row belongs to
 * the block that contains its middle; a block without rows has none; the remainder at the end is dropped.
 *   blocks   out: the number of whole blocks of the record; may be NULL
 * 0, or -1 with FL_SYSTEM in err. */
int fl_sample_block_maxima(int32_t n, const double *x, const double *edge, double length, fl_peaks *p,
                           int32_t *blocks, fl_err *err);

#endif
