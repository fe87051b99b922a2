/* SPDX-License-Identifier: GPL-3.0-or-later */
/* startup.h -- the start-up of a record, where it is sure.
 *
 * A run starts from a state that no long run has: no ice at the structure, or a front that hits it at once.
 * The record is cut into B blocks of equal length with means y_1 .. y_B.  Leaving out the first d blocks, the
 * standard error of the mean of the rest is
 *     e(d)^2 = sum over k > d of (y_k - mean)^2 / (B - d)^2,
 * and the d of the smallest e is where the start-up ends (MSER, White 1997).  It is sure where
 *   - d is below B/2: a record whose best cut is in its second half does not settle;
 *   - the rest is stationary, stationary.h, and long enough to be judged;
 *   - means of start-up and rest are more than z = 4 standard errors apart,
 *         z = |m_start - m_rest| / (s sqrt(2 tau (1/T_start + 1/T_rest))),
 *     s and tau those of the rest, integral_time.h: of a stationary record of independent values one in some
 *     thousands has such a start.
 * Source: White, Simulation 69 (1997) 323. */
#ifndef FL_STAT_STARTUP_H
#define FL_STAT_STARTUP_H
#include <stdint.h>
#include "base/err.h"

typedef struct {
    int32_t rows;          /* of the start-up; 0: none is sure */
    double mean[2], apart; /* means of start-up and rest, and z; 0 with rows = 0 */
} fl_startup;

/* Of x[n], rows of equal length over a time span [s].  0, or -1 with FL_SYSTEM in err. */
int fl_startup_find(fl_startup *s, int32_t n, const double *x, double span, fl_err *err);

#endif
