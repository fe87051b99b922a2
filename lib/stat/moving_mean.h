/* SPDX-License-Identifier: GPL-3.0-or-later */
/* moving_mean.h -- centred moving mean of a record.
 *
 *     y_k = (1/T) int_(c_k - T/2)^(c_k + T/2) x(t) dt,  c_k the middle of interval k,
 * where x[k] holds for edge[k] .. edge[k + 1]; intervals need not be equal.  Where the window extends beyond
 * an end of the record it is the mean over the part inside, so a constant is preserved.  There is no phase
 * shift. In the middle of a long record the gain is sin(pi f T) / (pi f T), which is negative from f = 1/T
 * on. */
#ifndef FL_STAT_MOVING_MEAN_H
#define FL_STAT_MOVING_MEAN_H
#include <stdint.h>
#include "base/err.h"

/*   edge[n + 1], x[n]   the record [s, unit]
 *   T                   length of the window [s]
 *   y[n]                out; not x
 * 0, or -1 with FL_INPUT (T is not above 0, or longer than the record) or FL_SYSTEM in err. */
int fl_moving_mean(int32_t n, const double *edge, const double *x, double T, double *y, fl_err *err);

#endif
