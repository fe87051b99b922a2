/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_mean.h -- the moving mean of a record. */
#ifndef FL_STAT_MOVING_MEAN_H
#define FL_STAT_MOVING_MEAN_H
#include <stdint.h>
#include "base/err.h"

/* The mean of x over a window of length T about the middle c_k of each interval,
 *     y_k = (1/T) int_(c_k - T/2)^(c_k + T/2) x(t) dt,
 * where x[k] holds for edge[k] .. edge[k + 1]; intervals need not be equal.  Where the window reaches over an
 * end of the record it is the mean over the part that lies within, so a constant stays what it is.  Nothing
 * is shifted in time; in the middle of a long record the gain is sin(pi f T) / (pi f T), which is below 0
 * from f = 1/T on. edge[n + 1], x[n], y[n] out; y is not x 0, or -1 with FL_INPUT (T is not above 0, or
 * longer than the record) or FL_SYSTEM in err. */
int fl_moving_mean(int32_t n, const double *edge, const double *x, double T, double *y, fl_err *err);

#endif
